#include "importer/site/site_plan.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <deque>
#include <limits>
#include <utility>
#include <vector>

#include <Eigen/Geometry>
#include <fmt/format.h>

#include "core/error.h"
#include "importer/site/enclosing_solid.h"
#include "importer/site/floor_rays.h"
#include "importer/site/free_space.h"
#include "importer/site/region_choice.h"
#include "sim/mujoco.h"

namespace patrol::importer {
namespace {

constexpr float kNoGround_m = std::numeric_limits<float>::quiet_NaN();

/// Flood of the ground of a site.
class GroundFlood {
 public:
  static constexpr std::array<std::array<int, 2>, 4> kNeighbors = {{{1, 0}, {-1, 0}, {0, 1}, {0, -1}}};

  /// The grid contains `points_m`.
  GroundFlood(const mjModel& site, const std::vector<Eigen::Vector2d>& points_m, const SitePlanSettings& settings)
      : rays_(site), settings_(settings) {
    const Eigen::AlignedBox3d& surfaces = rays_.box();
    Eigen::AlignedBox3d box = surfaces;
    for (const Eigen::Vector2d& p_m : points_m) {
      const Eigen::Vector3d point(p_m.x(), p_m.y(), surfaces.min().z());
      if (surfaces.exteriorDistance(point) <= settings.max_outside_m) box.extend(point);
    }
    const Eigen::Vector2d low = box.min().head<2>().array() - settings.margin_m,
                          size = box.max().head<2>().array() + settings.margin_m - low.array();
    double cell_m = settings.cell_m;
    while (size.x() * size.y() / (cell_m * cell_m) > settings.max_cells) cell_m *= 2.0;
    const GridGeometry grid{.resolution_m = cell_m,
                            .width = static_cast<int>(std::ceil(size.x() / cell_m)),
                            .height = static_cast<int>(std::ceil(size.y() / cell_m)),
                            .origin_m = low};
    ground_m_ = Grid<float>(grid, kNoGround_m);
    region_ = Grid<std::int32_t>(grid, 0);
  }

  const GridGeometry& grid() const { return ground_m_.geometry(); }

  /// Floods from a cell, unless it is flooded already or has no ground. Returns the area of the region.
  std::optional<RegionArea> flood_from(Cell start) {
    if (!grid().contains(start) || region_.at(start) != 0) return std::nullopt;
    const std::optional<double> floor_m = rays_.lowest_floor_m(grid().center_of(start), settings_.height_m);
    if (!floor_m) return std::nullopt;
    const std::int32_t label = ++num_regions_;
    std::deque<Cell> front = {start};
    region_.at(start) = label;
    ground_m_.at(start) = static_cast<float>(*floor_m);
    RegionArea area;
    while (!front.empty()) {
      const Cell cell = front.front();
      front.pop_front();
      area.add(grid(), cell, settings_.margin_m);
      for (const auto& [dc, dr] : kNeighbors) {
        const Cell next{cell.col + dc, cell.row + dr};
        if (!grid().contains(next) || region_.at(next) != 0) continue;
        const std::optional<double> height_m = step_m(cell, next);
        if (!height_m) continue;
        region_.at(next) = label;
        ground_m_.at(next) = static_cast<float>(*height_m);
        front.push_back(next);
      }
    }
    return area;
  }

  std::int32_t last_region() const { return num_regions_; }
  std::int32_t region_at(Cell cell) const { return region_.at(cell); }

  /// Point above the ground in a flooded cell, at the height above which a robot is blocked.
  Eigen::Vector3d point_above(Cell cell) const {
    const Eigen::Vector2d p = grid().center_of(cell);
    return {p.x(), p.y(), double{ground_m_.at(cell)} + settings_.max_step_m};
  }

  /// Plan of a region: its cells are free. Cells beside it that hold an obstacle are occupied, and those of its cells
  /// that hold a surface thinner than a cell, which the flood reached from both sides.
  OccupancyGrid plan_of_region(std::int32_t label) const {
    OccupancyGrid plan(grid(), -1);
    std::vector<Cell> thin;
    for (int row = 0; row < grid().height; ++row) {
      for (int col = 0; col < grid().width; ++col) {
        const Cell cell{col, row};
        if (region_.at(cell) != label) continue;
        plan.at(cell) = 0;
        for (const auto& [dc, dr] : kNeighbors) {
          const Cell next{col + dc, row + dr};
          if (!grid().contains(next)) continue;
          if (region_.at(next) != label) {
            if (is_obstacle(cell, next)) plan.at(next) = 100;
          } else if (dc + dr > 0) {  // each pair once
            if (const std::optional<double> distance_m = wall_distance_m(cell, next))
              thin.push_back(*distance_m < 0.5 * grid().resolution_m ? cell : next);
          }
        }
      }
    }
    for (const Cell cell : thin) plan.at(cell) = 100;
    return plan;
  }

 private:
  /// Distance of the first surface from the center of a cell to that of its neighbor, at a height above the ground of
  /// the first; none without a surface between them.
  std::optional<double> surface_between_m(Cell from, Cell to, double above_m) const {
    const Eigen::Vector2d p = grid().center_of(from), step = grid().center_of(to) - p;
    const Eigen::Vector3d origin(p.x(), p.y(), static_cast<double>(ground_m_.at(from)) + above_m);
    const Eigen::Vector3d direction(step.x() / step.norm(), step.y() / step.norm(), 0.0);
    return rays_.distance_m(origin, direction, step.norm());
  }

  /// Distance of the first surface between two neighboring cells at the heights at which a robot is blocked.
  std::optional<double> wall_distance_m(Cell from, Cell to) const {
    for (const double above_m : {settings_.max_step_m + settings_.min_obstacle_m, 0.5 * settings_.height_m}) {
      if (const std::optional<double> distance_m = surface_between_m(from, to, above_m)) return distance_m;
    }
    return std::nullopt;
  }

  /// Ground of a neighboring cell that can be reached from `from`.
  std::optional<double> step_m(Cell from, Cell to) const {
    const double ground_m = static_cast<double>(ground_m_.at(from));
    const std::optional<double> height_m = rays_.surface_below_m(grid().center_of(to), ground_m + settings_.height_m);
    if (!height_m || std::abs(*height_m - ground_m) > settings_.max_step_m) return std::nullopt;
    return wall_distance_m(from, to) ? std::nullopt : height_m;
  }

  /// Whether a cell beside a ground cell holds a surface above the ground, or is behind one.
  bool is_obstacle(Cell from, Cell to) const {
    const double ground_m = static_cast<double>(ground_m_.at(from));
    const std::optional<double> height_m = rays_.surface_below_m(grid().center_of(to), ground_m + settings_.height_m);
    if (height_m && *height_m - ground_m > settings_.min_obstacle_m) return true;
    return wall_distance_m(from, to).has_value();
  }

  FloorRays rays_;
  SitePlanSettings settings_;
  Grid<float> ground_m_;       ///< heights of the ground; NaN where there is none
  Grid<std::int32_t> region_;  ///< label of the flooded region, from 1; 0: none
  std::int32_t num_regions_ = 0;
};

/// `point_m`: above the ground at the start.
void refuse_point_in_solid(const mjModel& site, const Eigen::Vector3d& point_m) {
  const sim::DataPtr data = sim::make_data(site);
  mj_kinematics(&site, data.get());
  if (const std::optional<std::string> solid = enclosing_solid(site, *data, point_m))
    throw InputError(fmt::format("start ({:.2f}, {:.2f}): inside of {}", point_m.x(), point_m.y(),
                                 solid->empty() ? "an obstacle" : *solid));
}

/// Whether the free cells of a plan end at obstacles, and not at drops as the top of an object.
bool is_walled(const OccupancyGrid& plan) {
  const GridGeometry& grid = plan.geometry();
  int num_walls = 0, num_drops = 0;
  for (int row = 0; row < grid.height; ++row) {
    for (int col = 0; col < grid.width; ++col) {
      if (plan.at({col, row}) != kFree) continue;
      for (const auto& [dc, dr] : GroundFlood::kNeighbors) {
        const Cell next{col + dc, row + dr};
        if (!grid.contains(next) || plan.at(next) == kFree) continue;
        (plan.at(next) == kOccupied ? num_walls : num_drops)++;
      }
    }
  }
  return num_walls > num_drops;
}

/// Floods the ground from the cells of a grid of 1 m, and chooses a region.
class LargestGround {
 public:
  LargestGround(const mjModel& site, const SitePlanSettings& settings)
      : site_(site), settings_(settings), flood_(site, {}, settings), data_(sim::make_data(site)) {
    constexpr double kStartSpacing_m = 1.0;
    mj_kinematics(&site, data_.get());
    const GridGeometry& grid = flood_.grid();
    const int spacing = std::max(1, static_cast<int>(kStartSpacing_m / grid.resolution_m));
    std::vector<Cell> starts;
    for (int row = spacing / 2; row < grid.height; row += spacing) {
      for (int col = spacing / 2; col < grid.width; col += spacing) {
        starts.push_back({col, row});
        if (const std::optional<RegionArea> area = flood_.flood_from(starts.back())) areas_.push_back(*area);
      }
    }
    starts_.resize(areas_.size());
    for (const Cell cell : starts) {
      if (const std::int32_t label = flood_.region_at(cell); label > 0)
        starts_[static_cast<std::size_t>(label) - 1].push_back(cell);
    }
  }

  SitePlan plan() const {
    std::vector<std::size_t> regions;
    std::vector<RegionArea> areas;
    for (std::size_t i = 0; i < areas_.size(); ++i) {
      if (is_majority(i, [&](const auto& point) { return enclosing_solid(site_, *data_, point).has_value(); }))
        continue;
      regions.push_back(i);
      areas.push_back(areas_[i]);
    }
    if (areas.empty())
      throw InputError(areas_.empty() ? "the site has no ground" : "the site has no ground outside of solids");
    bool is_too_narrow = false;
    OccupancyGrid map;  // of the region that is_usable() has accepted
    const auto is_usable = [&](std::size_t i) {
      if (is_majority(regions[i], [&](const auto& point) { return is_below_back_face(site_, *data_, point); }))
        return false;
      map = map_of(regions[i]);
      if (!is_walled(map)) return false;
      const bool is_wide = area_with_clearance_m2(map, settings_.clearance_m) >= kMinEnclosed_m2;
      is_too_narrow |= !is_wide;
      return is_wide;
    };
    const RegionChoice choice = *choose_region(areas, is_usable);
    if (choice.is_enclosed) return {.map = std::move(map), .is_enclosed = true};
    return {.map = map_of(regions[choice.index]), .is_too_narrow = is_too_narrow};
  }

 private:
  OccupancyGrid map_of(std::size_t region) const {
    return flood_.plan_of_region(static_cast<std::int32_t>(region) + 1);
  }

  /// Whether a condition is met at most of the tested points of a region.
  template <typename Condition>
  bool is_majority(std::size_t region, Condition condition) const {
    constexpr std::size_t kMaxTested = 20;
    const std::vector<Cell>& cells = starts_[region];
    const std::size_t step = cells.size() / kMaxTested + 1;
    std::size_t num = 0, num_met = 0;
    for (std::size_t i = 0; i < cells.size(); i += step) {
      ++num;
      num_met += condition(flood_.point_above(cells[i])) ? 1 : 0;
    }
    return 2 * num_met > num;
  }

  const mjModel& site_;
  SitePlanSettings settings_;
  GroundFlood flood_;
  sim::DataPtr data_;
  std::vector<RegionArea> areas_;          ///< [region]
  std::vector<std::vector<Cell>> starts_;  ///< cells of the grid of 1 m, [region]
};

}  // namespace

SitePlan plan_of(const mjModel& site, const std::optional<Eigen::Vector2d>& p_start_m,
                 const std::vector<Eigen::Vector2d>& stations_m, const SitePlanSettings& settings) {
  if (!p_start_m) return LargestGround(site, settings).plan();
  std::vector<Eigen::Vector2d> points_m = stations_m;
  points_m.push_back(*p_start_m);
  GroundFlood flood(site, points_m, settings);
  const Cell start = flood.grid().cell_at(*p_start_m);
  if (!flood.flood_from(start))
    throw InputError(fmt::format("start ({:.2f}, {:.2f}): no ground", p_start_m->x(), p_start_m->y()));
  refuse_point_in_solid(site, {p_start_m->x(), p_start_m->y(), flood.point_above(start).z()});
  return {.map = flood.plan_of_region(flood.last_region())};
}

void refuse_start_in_solid(const mjModel& site, const Eigen::Vector2d& p_start_m, const SitePlanSettings& settings) {
  const std::optional<double> floor_m = FloorRays(site).lowest_floor_m(p_start_m, settings.height_m);
  if (floor_m) refuse_point_in_solid(site, {p_start_m.x(), p_start_m.y(), *floor_m + settings.max_step_m});
}

}  // namespace patrol::importer
