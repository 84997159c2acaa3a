#include "importer/site/free_space.h"

#include <algorithm>
#include <cmath>
#include <deque>
#include <limits>

#include <fmt/format.h>

#include "core/error.h"
#include "core/geometry/distance_transform.h"
#include "core/map_cells.h"
#include "core/random.h"
#include "importer/site/region_choice.h"

namespace patrol::importer {
namespace {

constexpr double kAccuracy_m = 0.3;   // position tolerance of a station
constexpr double kRounding_m = 1e-9;  // of clearances

/// Returns the distance from the center of each cell to the face of the nearest cell that is not free, m. Negative: the
/// cell is not free itself. Across the corner of a cell, the distance is up to 0.2 cells more.
std::vector<double> clearances_m(const OccupancyGrid& plan) {
  std::vector<std::uint8_t> is_blocked(plan.geometry().size());
  std::transform(plan.values().begin(), plan.values().end(), is_blocked.begin(),
                 [](std::int8_t percent) { return static_cast<std::uint8_t>(is_free(percent) ? 0 : 1); });
  std::vector<double> result = squared_distances(is_blocked, plan.geometry().width, plan.geometry().height);
  for (double& value : result) value = (std::sqrt(value) - 0.5) * plan.geometry().resolution_m;
  return result;
}

/// Returns the cells with enough clearance to the nearest cell that is not free.
Grid<std::uint8_t> cells_with_clearance(const OccupancyGrid& plan, double min_clearance_m) {
  const std::vector<double> clearance_m = clearances_m(plan);
  Grid<std::uint8_t> result(plan.geometry());
  std::transform(clearance_m.begin(), clearance_m.end(), result.values().begin(),
                 [&](double distance_m) { return distance_m >= min_clearance_m - kRounding_m ? 1 : 0; });
  return result;
}

/// Returns the distance from a position to the nearest cell that is not free, at most `max_m`.
double clearance_at(const OccupancyGrid& plan, const Eigen::Vector2d& p_m, double max_m) {
  const GridGeometry& grid = plan.geometry();
  const Cell low = grid.cell_at(p_m.array() - max_m), high = grid.cell_at(p_m.array() + max_m);
  double clearance_m = max_m;
  for (int row = std::max(low.row, 0); row <= std::min(high.row, grid.height - 1); ++row) {
    for (int col = std::max(low.col, 0); col <= std::min(high.col, grid.width - 1); ++col) {
      if (is_free(plan.at({col, row}))) continue;
      const Eigen::Array2d to_center = (grid.center_of({col, row}) - p_m).array().abs();
      clearance_m = std::min(clearance_m, (to_center - 0.5 * grid.resolution_m).max(0.0).matrix().norm());
    }
  }
  return clearance_m;
}

/// Marks the cells connected to `from` with `label`, and returns their area. Cells of the value 1 are open.
RegionArea flood(Grid<std::uint8_t>& open, Cell from, std::uint8_t label, double margin_m) {
  std::deque<Cell> front = {from};
  open.at(from) = label;
  RegionArea area;
  while (!front.empty()) {
    const Cell cell = front.front();
    front.pop_front();
    area.add(open.geometry(), cell, margin_m);
    for (const Cell next : {Cell{cell.col + 1, cell.row}, Cell{cell.col - 1, cell.row}, Cell{cell.col, cell.row + 1},
                            Cell{cell.col, cell.row - 1}}) {
      if (!open.geometry().contains(next) || open.at(next) != 1) continue;
      open.at(next) = label;
      front.push_back(next);
    }
  }
  return area;
}

std::optional<Cell> nearest_open(const Grid<std::uint8_t>& open, const Eigen::Vector2d& p_m) {
  std::optional<Cell> best;
  double min_distance = std::numeric_limits<double>::infinity();
  const GridGeometry& grid = open.geometry();
  for (int row = 0; row < grid.height; ++row) {
    for (int col = 0; col < grid.width; ++col) {
      const double distance = (grid.center_of({col, row}) - p_m).squaredNorm();
      if (open.at({col, row}) != 0 && distance < min_distance) best = Cell{col, row}, min_distance = distance;
    }
  }
  return best;
}

/// Cell of a region, and whether the region is inside of walls.
struct RegionSeed {
  Cell cell;
  bool is_enclosed = false;
};

std::optional<RegionSeed> seed_by_area(const Grid<std::uint8_t>& open, double margin_m) {
  const GridGeometry& grid = open.geometry();
  Grid<std::uint8_t> rest = open;
  std::vector<Cell> seeds;
  std::vector<RegionArea> areas;
  for (int row = 0; row < grid.height; ++row) {
    for (int col = 0; col < grid.width; ++col) {
      if (rest.at({col, row}) != 1) continue;
      seeds.push_back({col, row});
      areas.push_back(flood(rest, {col, row}, 2, margin_m));
    }
  }
  const double cell_m2 = grid.resolution_m * grid.resolution_m;
  const std::optional<RegionChoice> choice = choose_region(
      areas, [&](std::size_t i) { return cell_m2 * static_cast<double>(areas[i].num_cells) >= kMinEnclosed_m2; });
  if (!choice) return std::nullopt;
  return RegionSeed{.cell = seeds[choice->index], .is_enclosed = choice->is_enclosed};
}

}  // namespace

double area_with_clearance_m2(const OccupancyGrid& plan, double min_clearance_m) {
  const Grid<std::uint8_t> open = cells_with_clearance(plan, min_clearance_m);
  const auto num_open = std::count(open.values().begin(), open.values().end(), std::uint8_t{1});
  return plan.geometry().resolution_m * plan.geometry().resolution_m * static_cast<double>(num_open);
}

FreeSpace::FreeSpace(const OccupancyGrid& plan, double min_clearance_m, const std::optional<Eigen::Vector2d>& p_start_m,
                     double margin_m)
    : grid_(plan.geometry()), region_(cells_with_clearance(plan, min_clearance_m)) {
  std::optional<RegionSeed> seed;
  if (!p_start_m) seed = seed_by_area(region_, margin_m);
  else if (const std::optional<Cell> nearest = nearest_open(region_, *p_start_m)) seed = RegionSeed{.cell = *nearest};
  if (!seed) throw InputError(fmt::format("the plan has no free cell with a clearance of {:.2g} m", min_clearance_m));
  is_enclosed_ = seed->is_enclosed;
  flood(region_, seed->cell, 2, margin_m);
  for (int row = 0; row < grid_.height; ++row) {
    for (int col = 0; col < grid_.width; ++col) {
      std::uint8_t& cell = region_.at({col, row});
      cell = cell == 2 ? 1 : 0;
      if (cell == 1) cells_m_.push_back(grid_.center_of({col, row}));
    }
  }
}

bool FreeSpace::contains(const Eigen::Vector2d& p_m) const {
  const Cell cell = grid_.cell_at(p_m);
  return grid_.contains(cell) && region_.at(cell) != 0;
}

Eigen::Vector2d FreeSpace::nearest(const Eigen::Vector2d& p_m) const {
  return grid_.center_of(*nearest_open(region_, p_m));
}

std::optional<std::string> clearance_problem(const OccupancyGrid& plan, double min_clearance_m,
                                             const Eigen::Vector2d& p_m) {
  const Cell cell = plan.geometry().cell_at(p_m);
  if (!plan.geometry().contains(cell)) return "outside the floor plan";
  if (is_occupied(plan.at(cell))) return "in a wall or an obstacle of the floor plan";
  if (!is_free(plan.at(cell))) return "not on the free ground of the floor plan";
  const double clearance_m = clearance_at(plan, p_m, min_clearance_m);
  if (clearance_m >= min_clearance_m - kRounding_m) return std::nullopt;
  return fmt::format("{:.2f} m from walls or unknown space: the robot needs at least {:.2f} m", clearance_m,
                     min_clearance_m);
}

std::vector<Station> random_stations(const FreeSpace& space, const Pose2& start, int count, std::uint64_t seed,
                                     double separation_m) {
  constexpr int kDraws = 100;
  const RandomStream stream(seed, "stations");
  const std::vector<Eigen::Vector2d>& cells = space.cells_m();
  std::vector<Station> stations;
  std::vector<Eigen::Vector2d> taken = {start.position()};
  Eigen::Vector2d last = start.position();
  std::uint64_t draw = 0;
  for (int number = 1; number <= count; ++number) {
    const auto is_apart = [&](const Eigen::Vector2d& p, double distance_m) {
      return std::all_of(taken.begin(), taken.end(),
                         [&](const auto& other) { return (p - other).norm() >= distance_m; });
    };
    Eigen::Vector2d p = start.position();
    double distance_m = separation_m;
    for (int tries = 0;; ++tries) {
      if (tries == kDraws) tries = 0, distance_m /= 2.0;
      const auto index = static_cast<std::size_t>(stream.uniform(draw++) * static_cast<double>(cells.size()));
      p = cells[std::min(index, cells.size() - 1)];
      if (is_apart(p, distance_m) || distance_m < 1e-3) break;
    }
    const Eigen::Vector2d moved = p - last;
    stations.push_back({.number = number,
                        .name = fmt::format("station_{}", number),
                        .type = StationType::kPass,
                        .T_route_body = {p.x(), p.y(), std::atan2(moved.y(), moved.x())},
                        .accuracy_m = kAccuracy_m});
    taken.push_back(p);
    last = p;
  }
  stations.push_back({.number = count + 1,
                      .name = "home",
                      .type = StationType::kHome,
                      .T_route_body = start,
                      .accuracy_m = kAccuracy_m});
  return stations;
}

std::vector<Station> stations_along(const std::vector<Pose2>& path, const FreeSpace& space, double spacing_m) {
  std::vector<Station> stations;
  double length_m = 0.0, next_m = spacing_m;
  for (std::size_t i = 1; i < path.size(); ++i) {
    length_m += (path[i].position() - path[i - 1].position()).norm();
    const bool is_last = i + 1 == path.size();
    if ((length_m < next_m && !is_last) || !space.contains(path[i].position())) continue;
    next_m = length_m + spacing_m;
    const int number = static_cast<int>(stations.size()) + 1;
    stations.push_back({.number = number,
                        .name = fmt::format("station_{}", number),
                        .type = StationType::kPass,
                        .T_route_body = path[i],
                        .accuracy_m = kAccuracy_m});
  }
  if (stations.empty()) throw InputError("no pose of the recorded path is in free space");
  stations.back().type = StationType::kHome;
  return stations;
}

}  // namespace patrol::importer
