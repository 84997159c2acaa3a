#include "plan/costmap.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <numbers>
#include <utility>

#include <fmt/format.h>

#include "core/error.h"
#include "core/segment.h"

namespace patrol::plan {
namespace {

constexpr double kGrowth_m = 5.0;  ///< added at each growth, so that growth is rare
constexpr int kMoving_cells = 3;     ///< a low obstacle this near to a live hit may be a person's foot
constexpr int kExplained_cells = 2;  ///< an echo this near to what the lidar hits is that

/// Reach of the distance field in cells: all that costs, and all that the robot's outline may ask for.
int cap_of(const CostmapSettings& settings, const Footprint& footprint) {
  const double reach_m = std::max(settings.inflation_radius_m, footprint.circumscribed_radius_m() + 0.3);
  return std::clamp(static_cast<int>(std::ceil(reach_m / settings.resolution_m)) + 1, 2, 100);
}

/// What is nearer than the lethal distance must be within the field's reach, or it would be taken for free.
void check_reach(const CostmapSettings& settings, const Footprint& footprint, double lethal_m) {
  const double reach_m = settings.resolution_m * (cap_of(settings, footprint) - 1);
  if (lethal_m <= reach_m) return;
  throw InputError(fmt::format("an outline and margins of {:.2f} m reach beyond the costmap's {:.2f} m: costmap.inflation_radius_m or "
                               "costmap.resolution_m must be larger", lethal_m, reach_m));
}

/// Cost of being `beyond_m` farther than the lethal distance, falling to 1/e over `decay_m`.
Cost decaying_cost(double beyond_m, double decay_m) {
  return static_cast<Cost>(std::lround(kMaxPassableCost * std::exp(-beyond_m / decay_m)));
}

/// How far the scan is known to see in each direction, around the lidar: the shortest beam of each sector.
class SeenRange {
 public:
  explicit SeenRange(const LevelScan& scan)
      : sectors_(std::clamp<std::size_t>(scan.beams.size() / 2, 1, 720), 0.0f),
        sectors_per_rad_(static_cast<double>(sectors_.size()) / (2.0 * std::numbers::pi)) {
    for (const LevelScan::Beam& beam : scan.beams) {
      const Eigen::Vector2d along = beam.end_m.cast<double>() - scan.origin_m;
      float& range = sectors_[sector(along)];
      const auto length = static_cast<float>(along.norm());
      range = range > 0.0f ? std::min(range, length) : length;
    }
  }
  /// 0 where no beam went.
  double along(const Eigen::Vector2d& direction) const { return sectors_[sector(direction)]; }

 private:
  std::size_t sector(const Eigen::Vector2d& direction) const {
    const double angle = std::atan2(direction.y(), direction.x()) + std::numbers::pi;
    return std::min(static_cast<std::size_t>(angle * sectors_per_rad_), sectors_.size() - 1);
  }

  std::vector<float> sectors_;
  double sectors_per_rad_;
};

}  // namespace

void Costmap::CellBox::extend(Cell cell) {
  if (is_empty()) {
    min = max = cell;
    return;
  }
  min = {std::min(min.col, cell.col), std::min(min.row, cell.row)};
  max = {std::max(max.col, cell.col), std::max(max.row, cell.row)};
}

Costmap::CellBox Costmap::CellBox::grown(int cells, const GridGeometry& within) const {
  CellBox box;
  box.min = {std::max(0, min.col - cells), std::max(0, min.row - cells)};
  box.max = {std::min(within.width - 1, max.col + cells), std::min(within.height - 1, max.row + cells)};
  return box;
}

Costmap::Costmap(const CostmapSettings& settings, const Footprint& footprint, std::vector<Polyline> keep_out_lines_in_map)
    : settings_(settings),
      footprint_(footprint),
      keep_out_lines_(std::move(keep_out_lines_in_map)),
      transform_(cap_of(settings, footprint)),
      low_(settings.low) {
  validate(settings_, "costmap");
  const double lethal_m = footprint_.inscribed_radius_m() + settings_.safety_margin_m + settings_.route_margin_m;
  check_reach(settings_, footprint_, lethal_m);
  for (int squared = 0; squared <= transform_.beyond(); ++squared) {
    // Somewhere in its cell an obstacle has its surface; half a cell is the middle guess.
    const double distance = std::max(0.0, settings_.resolution_m * (std::sqrt(squared) - 0.5));
    distance_of_.push_back(distance);
    const bool is_felt = squared < transform_.beyond() && distance <= settings_.inflation_radius_m;
    const Cost decayed = is_felt ? decaying_cost(distance - lethal_m, settings_.inflation_decay_m) : kFreeCost;
    obstacle_cost_of_.push_back(squared < transform_.beyond() && distance <= lethal_m ? kLethalCost : decayed);
  }
  for (const Polyline& line : keep_out_lines_) {
    for (const Eigen::Vector2d& p : line) include(p, 1.0);
  }
  include(Eigen::Vector2d::Zero(), kGrowth_m);
}

void Costmap::include(const Eigen::Vector2d& p_map, double margin_m) {
  const double res = settings_.resolution_m;
  const auto lattice = [res](double x) { return static_cast<int>(std::floor(x / res)); };
  const Cell min{lattice(p_map.x() - margin_m), lattice(p_map.y() - margin_m)};
  const Cell max{lattice(p_map.x() + margin_m) + 1, lattice(p_map.y() + margin_m) + 1};
  if (geometry().size() == 0) return allocate(min, max);

  const Cell old_min = lattice_origin_;
  const Cell old_max{old_min.col + geometry().width, old_min.row + geometry().height};
  const int extra = static_cast<int>(kGrowth_m / res);
  const auto low = [extra](int wanted, int now) { return wanted < now ? wanted - extra : now; };
  const auto high = [extra](int wanted, int now) { return wanted > now ? wanted + extra : now; };
  const Cell new_min{low(min.col, old_min.col), low(min.row, old_min.row)};
  const Cell new_max{high(max.col, old_max.col), high(max.row, old_max.row)};
  if (new_min != old_min || new_max != old_max) allocate(new_min, new_max);
}

// Takes the map layer and the live obstacles along to the new geometry, and works everything else out again.
void Costmap::allocate(Cell min, Cell max) {
  const GridGeometry geometry{.resolution_m = settings_.resolution_m,
                              .width = max.col - min.col,
                              .height = max.row - min.row,
                              .origin_m = settings_.resolution_m * Eigen::Vector2d(min.col, min.row)};
  const Cell shift{lattice_origin_.col - min.col, lattice_origin_.row - min.row};
  lattice_origin_ = min;
  OccupancyGrid map(geometry, kUnknown);
  for (int row = 0; row < map_.geometry().height; ++row) {
    const std::int8_t* source = &map_.at({0, row});
    std::copy(source, source + map_.geometry().width, &map.at({shift.col, shift.row + row}));
  }
  map_ = std::move(map);
  live_ = Grid<std::uint32_t>(geometry, 0);
  is_low_ = Grid<std::uint8_t>(geometry, 0);
  for (const Cell lattice : low_.obstacles()) is_low_.at(to_grid(lattice)) = 1;
  squared_ = Grid<std::int16_t>(geometry, transform_.beyond());
  cost_ = Grid<Cost>(geometry, kFreeCost);
  for (std::size_t i = 0; i < live_cells_.size(); ++i) {
    live_.at(to_cell(live_cells_[i])) = static_cast<std::uint32_t>(i + 1);
  }
  lay_keep_out_lines();
  CellBox all;
  all.extend({0, 0});
  all.extend({geometry.width - 1, geometry.height - 1});
  refresh(all);
}

void Costmap::lay_keep_out_lines() {
  const double reach_m = settings_.keep_out_margin_m + std::max(settings_.keep_out_inflation_m, max_distance_m());
  keep_out_distance_m_ = Grid<float>(geometry(), static_cast<float>(reach_m));
  for (const Polyline& line : keep_out_lines_) {
    for (std::size_t i = 0; i + 1 < line.size(); ++i) {
      const Eigen::Vector2d& a = line[i];
      const Eigen::Vector2d& b = line[i + 1];
      CellBox box;
      box.extend(geometry().cell_at(a.cwiseMin(b).array() - reach_m));
      box.extend(geometry().cell_at(a.cwiseMax(b).array() + reach_m));
      box = box.grown(0, geometry());
      for (int row = box.min.row; row <= box.max.row; ++row) {
        for (int col = box.min.col; col <= box.max.col; ++col) {
          float& nearest = keep_out_distance_m_.at({col, row});
          const double distance = distance_to_segment(geometry().center_of({col, row}), a, b);
          nearest = std::min(nearest, static_cast<float>(distance));
        }
      }
    }
  }
}

void Costmap::set_map(const OccupancyGrid& map) {
  const GridGeometry& source = map.geometry();
  if (source.resolution_m > settings_.resolution_m * (1.0 + 1e-9)) {
    throw InputError(fmt::format("costmap.resolution_m = {}: must be at least the map's resolution of {} m",
                                 settings_.resolution_m, source.resolution_m));
  }
  if (source.size() == 0) return;
  include(source.origin_m, 0.0);
  include(source.origin_m + source.resolution_m * Eigen::Vector2d(source.width, source.height), 0.0);

  OccupancyGrid pooled(geometry(), kUnknown);
  std::vector<int> col_of(static_cast<std::size_t>(source.width));
  for (int col = 0; col < source.width; ++col) {
    col_of[static_cast<std::size_t>(col)] = geometry().cell_at(source.center_of({col, 0})).col;
  }
  for (int row = 0; row < source.height; ++row) {
    std::int8_t* target = &pooled.at({0, geometry().cell_at(source.center_of({0, row})).row});
    const std::int8_t* values = &map.at({0, row});
    for (std::size_t col = 0; col < col_of.size(); ++col) {
      target[col_of[col]] = std::max(target[col_of[col]], values[col]);
    }
  }

  CellBox changed;
  for (int row = 0; row < geometry().height; ++row) {
    const std::int8_t* before = &map_.at({0, row});
    const std::int8_t* after = &pooled.at({0, row});
    const auto [first, unused] = std::mismatch(before, before + geometry().width, after);
    if (first == before + geometry().width) continue;
    int last = geometry().width - 1;
    while (before[last] == after[last]) --last;
    changed.extend({static_cast<int>(first - before), row});
    changed.extend({last, row});
  }
  map_ = std::move(pooled);
  refresh(changed);
}

void Costmap::add_scan(const LevelScan& scan, const Pose2& T_map_body) {
  include(T_map_body.position(), settings_.obstacle_range_m + settings_.resolution_m);
  CellBox changed;
  drop_live(scan, T_map_body, changed);
  mark_hits(scan, T_map_body, changed);
  refresh(changed);
}

// Takes away live obstacles that a beam has passed, that the map has by now, and that nobody has seen for long.
void Costmap::drop_live(const LevelScan& scan, const Pose2& T_map_body, CellBox& changed) {
  const SeenRange seen(scan);
  const Pose2 T_body_map = T_map_body.inverse();
  const Time memory = from_seconds(settings_.obstacle_memory_s);
  const double slack_m = 0.75 * settings_.resolution_m;
  for (std::size_t i = 0; i < live_cells_.size();) {
    const Cell cell = to_cell(live_cells_[i]);
    const Eigen::Vector2d from_lidar = T_body_map * geometry().center_of(cell) - scan.origin_m;
    const bool is_passed = seen.along(from_lidar) > from_lidar.norm() + slack_m;
    if (!is_passed && !is_in_map(cell, settings_.map_slack_cells) && scan.stamp - live_cells_[i].seen <= memory) {
      ++i;
      continue;
    }
    changed.extend(cell);
    live_.at(cell) = 0;
    live_cells_[i] = live_cells_.back();
    live_cells_.pop_back();
    if (i < live_cells_.size()) live_.at(to_cell(live_cells_[i])) = static_cast<std::uint32_t>(i + 1);
  }
}

void Costmap::mark_hits(const LevelScan& scan, const Pose2& T_map_body, CellBox& changed) {
  for (const LevelScan::Beam& beam : scan.beams) {
    const Eigen::Vector2d end_m = beam.end_m.cast<double>();
    if (!beam.is_hit || (end_m - scan.origin_m).norm() > settings_.obstacle_range_m) continue;
    const Eigen::Vector2d p_map = T_map_body * end_m;
    const Cell cell = geometry().cell_at(p_map);
    if (!live_.contains(cell) || is_in_map(cell, settings_.map_slack_cells)) continue;
    if (live_.at(cell) != 0) {
      live_cells_[live_.at(cell) - 1].seen = scan.stamp;
      continue;
    }
    const Cell lattice{cell.col + lattice_origin_.col, cell.row + lattice_origin_.row};
    live_cells_.push_back({.lattice = lattice, .seen = scan.stamp, .first_seen = scan.stamp});
    live_.at(cell) = static_cast<std::uint32_t>(live_cells_.size());
    changed.extend(cell);
  }
}

std::vector<Cell> Costmap::lattice_cells(const std::vector<Eigen::Vector2d>& p_level, const Pose2& T_map_body,
                                         int min_count) const {
  std::map<std::pair<int, int>, int> counts;  // in an order that does not depend on the points'
  for (const Eigen::Vector2d& p : p_level) {
    const Cell cell = geometry().cell_at(T_map_body * p);
    if (cost_.contains(cell)) ++counts[{cell.row + lattice_origin_.row, cell.col + lattice_origin_.col}];
  }
  std::vector<Cell> cells;
  for (const auto& [key, count] : counts) {
    if (count >= min_count) cells.push_back({key.second, key.first});
  }
  return cells;
}

bool Costmap::has_live_obstacle(Cell cell, int reach) const {
  for (int row = cell.row - reach; row <= cell.row + reach; ++row) {
    for (int col = cell.col - reach; col <= cell.col + reach; ++col) {
      if (is_live_obstacle({col, row})) return true;
    }
  }
  return false;
}

bool Costmap::is_in_map(Cell cell, int reach) const {
  for (int row = cell.row - reach; row <= cell.row + reach; ++row) {
    for (int col = cell.col - reach; col <= cell.col + reach; ++col) {
      if (map_.contains({col, row}) && map_.at({col, row}) >= settings_.occupied_percent) return true;
    }
  }
  return false;
}

void Costmap::add_image(const DepthPoints& points, Time stamp, const Pose2& T_map_body) {
  include(T_map_body.position(), settings_.obstacle_range_m);
  const std::vector<Cell> obstacles = lattice_cells(points.obstacles_m, T_map_body, settings_.low.min_camera_points);
  std::vector<bool> may_move;
  for (const Cell cell : obstacles) may_move.push_back(has_live_obstacle(to_grid(cell), kMoving_cells));
  // Ground, where no point of the same image speaks against it.
  std::vector<Cell> ground;
  const std::vector<Cell> doubtful = lattice_cells(points.obstacles_m, T_map_body, 1);
  for (const Cell cell : lattice_cells(points.ground_m, T_map_body, settings_.low.min_camera_points)) {
    if (std::find(doubtful.begin(), doubtful.end(), cell) == doubtful.end()) ground.push_back(cell);
  }
  low_.add_image(obstacles, ground, may_move, stamp);
  low_.forget_old(stamp);
  CellBox changed;
  apply_low_changes(changed);
  refresh(changed);
}

void Costmap::add_ping(const SonarCone& cone, Time stamp, const Pose2& T_map_body) {
  include(T_map_body.position(), settings_.obstacle_range_m);
  std::vector<Cell> arc = lattice_cells(cone.arc_m, T_map_body, 1);
  // An echo that the lidar explains, anywhere on the arc, is no news.
  const auto is_explained = [this](Cell lattice) {
    const Cell cell = to_grid(lattice);
    return has_live_obstacle(cell, kExplained_cells) || is_in_map(cell, kExplained_cells);
  };
  if (std::any_of(arc.begin(), arc.end(), is_explained)) arc.clear();
  low_.add_ping(arc, lattice_cells(cone.free_m, T_map_body, 1), stamp);
  CellBox changed;
  apply_low_changes(changed);
  refresh(changed);
}

void Costmap::apply_low_changes(CellBox& changed) {
  for (const Cell lattice : low_.take_changed()) {
    const Cell cell = to_grid(lattice);
    is_low_.at(cell) = low_.is_obstacle(lattice);
    changed.extend(cell);
  }
}

std::optional<Time> Costmap::live_since(const Eigen::Vector2d& p_map, double radius_m) const {
  const int reach = static_cast<int>(std::ceil(radius_m / settings_.resolution_m));
  const Cell center = geometry().cell_at(p_map);
  std::optional<Time> since;
  for (int row = center.row - reach; row <= center.row + reach; ++row) {
    for (int col = center.col - reach; col <= center.col + reach; ++col) {
      if (!is_live_obstacle({col, row}) || (geometry().center_of({col, row}) - p_map).norm() > radius_m) continue;
      const Time first_seen = live_cells_[live_.at({col, row}) - 1].first_seen;
      since = since ? std::min(*since, first_seen) : first_seen;
    }
  }
  return since;
}

void Costmap::forget_live(const Eigen::Vector2d& p_map, double radius_m) {
  CellBox changed;
  low_.forget_sonar([&](Cell lattice) { return (geometry().center_of(to_grid(lattice)) - p_map).norm() <= radius_m; });
  apply_low_changes(changed);
  std::vector<LiveObstacle> kept;
  for (const LiveObstacle& obstacle : live_cells_) {
    const Cell cell = to_cell(obstacle);
    live_.at(cell) = 0;
    if ((geometry().center_of(cell) - p_map).norm() > radius_m) {
      kept.push_back(obstacle);
      live_.at(cell) = static_cast<std::uint32_t>(kept.size());
    } else {
      changed.extend(cell);
    }
  }
  live_cells_ = std::move(kept);
  refresh(changed);
}

bool Costmap::is_occupied(Cell cell) const {
  return map_.at(cell) >= settings_.occupied_percent || live_.at(cell) != 0 || is_low_.at(cell) != 0;
}

// Distances change up to the cap around what changed, and depend on obstacles up to the cap around those.
void Costmap::refresh(const CellBox& changed) {
  if (changed.is_empty()) return;
  const CellBox target = changed.grown(transform_.cap_cells(), geometry());
  const CellBox source = changed.grown(2 * transform_.cap_cells(), geometry());
  const int width = source.max.col - source.min.col + 1, height = source.max.row - source.min.row + 1;
  window_obstacles_.resize(static_cast<std::size_t>(width) * static_cast<std::size_t>(height));
  std::uint8_t* obstacle = window_obstacles_.data();
  for (int row = source.min.row; row <= source.max.row; ++row) {
    for (int col = source.min.col; col <= source.max.col; ++col) *obstacle++ = is_occupied({col, row});
  }
  transform_.compute(window_obstacles_, width, height, window_squared_);

  const int count = target.max.col - target.min.col + 1;
  for (int row = target.min.row; row <= target.max.row; ++row) {
    const std::int16_t* squared = window_squared_.data() + static_cast<std::ptrdiff_t>(row - source.min.row) * width +
                                  (target.min.col - source.min.col);
    std::copy(squared, squared + count, &squared_.at({target.min.col, row}));
    price({target.min.col, row}, count);
  }
}

Cost Costmap::unknown_cost() const {
  return settings_.crosses_unknown ? static_cast<Cost>(std::lround(settings_.unknown_cost * kMaxPassableCost)) : kLethalCost;
}

/// Costs of `count` cells of a row.
void Costmap::price(Cell first, int count) {
  const std::int16_t* squared = &squared_.at(first);
  const std::int8_t* occupancy = &map_.at(first);
  const float* keep_out_m = &keep_out_distance_m_.at(first);
  Cost* cost = &cost_.at(first);
  const Cost unknown = unknown_cost();
  const auto margin_m = static_cast<float>(settings_.keep_out_margin_m);
  const auto reach_m = static_cast<float>(settings_.keep_out_margin_m + settings_.keep_out_inflation_m);
  for (int i = 0; i < count; ++i) {
    Cost worst = obstacle_cost_of_[static_cast<std::size_t>(squared[i])];
    if (occupancy[i] == kUnknown) worst = std::max(worst, unknown);
    if (keep_out_m[i] < reach_m) {
      const bool is_lethal = keep_out_m[i] <= margin_m;
      const double decay_m = settings_.keep_out_inflation_m / 3.0;
      worst = std::max(worst, is_lethal ? kLethalCost : decaying_cost(keep_out_m[i] - margin_m, decay_m));
    }
    cost[i] = worst;
  }
}

Cost Costmap::cost_at(const Eigen::Vector2d& p_map) const {
  const Cell cell = geometry().cell_at(p_map);
  if (cost_.contains(cell)) return cost_.at(cell);
  return unknown_cost();
}

namespace {

/// Between the centres of four cells; `value_at` takes a cell inside the grid. The border's values go on outside.
template <typename ValueAt>
double interpolate_bilinear(const GridGeometry& grid, const Eigen::Vector2d& p, const ValueAt& value_at) {
  const double col = (p.x() - grid.origin_m.x()) / grid.resolution_m - 0.5;
  const double row = (p.y() - grid.origin_m.y()) / grid.resolution_m - 0.5;
  const double col_floor = std::floor(col), row_floor = std::floor(row);
  const double u = col - col_floor, v = row - row_floor;
  const int left = std::clamp(static_cast<int>(col_floor), 0, grid.width - 1);
  const int low = std::clamp(static_cast<int>(row_floor), 0, grid.height - 1);
  const int right = std::min(left + 1, grid.width - 1), high = std::min(low + 1, grid.height - 1);
  return (1.0 - v) * ((1.0 - u) * value_at(Cell{left, low}) + u * value_at(Cell{right, low})) +
         v * ((1.0 - u) * value_at(Cell{left, high}) + u * value_at(Cell{right, high}));
}

}  // namespace

double Costmap::obstacle_distance_m(const Eigen::Vector2d& p_map) const {
  return interpolate_bilinear(geometry(), p_map, [this](Cell cell) {
    return distance_of_[static_cast<std::size_t>(squared_.at(cell))];
  });
}

double Costmap::keep_out_distance_m(const Eigen::Vector2d& p_map) const {
  return interpolate_bilinear(geometry(), p_map,
                              [this](Cell cell) { return static_cast<double>(keep_out_distance_m_.at(cell)); });
}

double Costmap::clearance_m(const Pose2& T_map_body) const {
  const double c = std::cos(T_map_body.yaw), s = std::sin(T_map_body.yaw);
  double clearance = std::numeric_limits<double>::infinity();
  for (const Disc& disc : footprint_.discs()) {
    const Eigen::Vector2d p_map(T_map_body.x + c * disc.center_m.x() - s * disc.center_m.y(),
                                T_map_body.y + s * disc.center_m.x() + c * disc.center_m.y());
    const double from_obstacle = obstacle_distance_m(p_map) - disc.radius_m - settings_.safety_margin_m;
    const double from_line = keep_out_distance_m(p_map) - settings_.keep_out_margin_m;
    clearance = std::min({clearance, from_obstacle, from_line});
  }
  return clearance;
}

}  // namespace patrol::plan
