#include "importer/site/site_plan.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <deque>
#include <limits>
#include <vector>

#include <Eigen/Geometry>
#include <fmt/format.h>

#include "core/error.h"
#include "importer/site/enclosing_solid.h"
#include "sim/geom_box.h"
#include "sim/lidar_scene.h"
#include "sim/mujoco.h"

namespace patrol::importer {
namespace {

constexpr float kNoGround_m = std::numeric_limits<float>::quiet_NaN();
constexpr double kAboveSurface_m = 1e-3;  // distance of a ray's origin from the surface below it

/// Box around the visible geoms that have an end, in world.
Eigen::AlignedBox3d box_around(const mjModel& site) {
  const sim::DataPtr data = sim::make_data(site);
  mj_kinematics(&site, data.get());
  Eigen::AlignedBox3d box;
  for (int geom = 0; geom < site.ngeom; ++geom) {
    if (site.geom_type[geom] == mjGEOM_PLANE) continue;
    box.extend(sim::geom_box(site, *data, geom));
  }
  if (box.isEmpty()) box.extend(Eigen::Vector3d::Zero());
  return box;
}

/// Flood of the ground of a site.
class GroundFlood {
 public:
  /// The grid contains `points_m`.
  GroundFlood(const mjModel& site, const std::vector<Eigen::Vector2d>& points_m, const SitePlanSettings& settings)
      : scene_(site), settings_(settings), box_(box_around(site)) {
    const Eigen::AlignedBox3d surfaces = box_;
    for (const Eigen::Vector2d& p_m : points_m) {
      const Eigen::Vector3d point(p_m.x(), p_m.y(), surfaces.min().z());
      if (surfaces.exteriorDistance(point) <= settings.max_outside_m) box_.extend(point);
    }
    const Eigen::Vector2d low = box_.min().head<2>().array() - settings.margin_m,
                          size = box_.max().head<2>().array() + settings.margin_m - low.array();
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

  /// Floods from a cell, unless it is flooded already or has no ground. Returns the number of cells.
  std::size_t flood_from(Cell start) {
    if (!grid().contains(start) || region_.at(start) != 0) return 0;
    const std::optional<double> floor_m = lowest_floor_m(grid().center_of(start));
    if (!floor_m) return 0;
    const std::int32_t label = ++num_regions_;
    std::deque<Cell> front = {start};
    region_.at(start) = label;
    ground_m_.at(start) = static_cast<float>(*floor_m);
    std::size_t count = 0;
    while (!front.empty()) {
      const Cell cell = front.front();
      front.pop_front();
      ++count;
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
    return count;
  }

  std::int32_t last_region() const { return num_regions_; }

  /// Height of the ground in a flooded cell.
  double ground_m(Cell cell) const { return double{ground_m_.at(cell)}; }

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
  static constexpr std::array<std::array<int, 2>, 4> kNeighbors = {{{1, 0}, {-1, 0}, {0, 1}, {0, -1}}};

  /// Height of the first surface below a point; none above nothing.
  std::optional<double> surface_below_m(const Eigen::Vector2d& p, double from_m) const {
    const double depth_m = from_m - box_.min().z() + 1.0;
    const auto hit = scene_.cast({p.x(), p.y(), from_m}, {0.0, 0.0, -1.0}, std::max(depth_m, 1.0), sim::kRayEverything);
    return hit ? std::optional(from_m - hit->distance_m) : std::nullopt;
  }

  /// Height of the lowest surface with free height above it.
  std::optional<double> lowest_floor_m(const Eigen::Vector2d& p) const {
    constexpr int kMaxSurfaces = 100;
    std::optional<double> floor_m;
    double above_m = std::numeric_limits<double>::infinity(), from_m = box_.max().z() + settings_.height_m + 1.0;
    for (int i = 0; i < kMaxSurfaces; ++i) {
      const std::optional<double> height_m = surface_below_m(p, from_m);
      if (!height_m) break;
      if (above_m - *height_m >= settings_.height_m) floor_m = height_m;
      above_m = *height_m;
      from_m = *height_m - kAboveSurface_m;
    }
    return floor_m;
  }

  /// Distance of the first surface from the center of a cell to that of its neighbor, at a height above the ground of
  /// the first; none without a surface between them.
  std::optional<double> surface_between_m(Cell from, Cell to, double above_m) const {
    const Eigen::Vector2d p = grid().center_of(from), step = grid().center_of(to) - p;
    const Eigen::Vector3d origin(p.x(), p.y(), static_cast<double>(ground_m_.at(from)) + above_m);
    const Eigen::Vector3d direction(step.x() / step.norm(), step.y() / step.norm(), 0.0);
    const auto hit = scene_.cast(origin, direction, step.norm(), sim::kRayEverything);
    return hit ? std::optional(hit->distance_m) : std::nullopt;
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
    const std::optional<double> height_m = surface_below_m(grid().center_of(to), ground_m + settings_.height_m);
    if (!height_m || std::abs(*height_m - ground_m) > settings_.max_step_m) return std::nullopt;
    return wall_distance_m(from, to) ? std::nullopt : height_m;
  }

  /// Whether a cell beside a ground cell holds a surface above the ground, or is behind one.
  bool is_obstacle(Cell from, Cell to) const {
    const double ground_m = static_cast<double>(ground_m_.at(from));
    const std::optional<double> height_m = surface_below_m(grid().center_of(to), ground_m + settings_.height_m);
    if (height_m && *height_m - ground_m > settings_.min_obstacle_m) return true;
    return wall_distance_m(from, to).has_value();
  }

  sim::LidarScene scene_;
  SitePlanSettings settings_;
  Eigen::AlignedBox3d box_;
  Grid<float> ground_m_;       ///< heights of the ground; NaN where there is none
  Grid<std::int32_t> region_;  ///< label of the flooded region, from 1; 0: none
  std::int32_t num_regions_ = 0;
};

/// `point_m`: above the ground at the start.
void refuse_start_in_solid(const mjModel& site, const Eigen::Vector3d& point_m) {
  const sim::DataPtr data = sim::make_data(site);
  mj_kinematics(&site, data.get());
  if (const std::optional<std::string> solid = enclosing_solid(site, *data, point_m))
    throw InputError(fmt::format("start ({:.2f}, {:.2f}): inside of {}", point_m.x(), point_m.y(),
                                 solid->empty() ? "an obstacle" : *solid));
}

}  // namespace

OccupancyGrid plan_of(const mjModel& site, const std::optional<Eigen::Vector2d>& p_start_m,
                      const std::vector<Eigen::Vector2d>& stations_m, const SitePlanSettings& settings) {
  constexpr double kStartSpacing_m = 1.0;
  std::vector<Eigen::Vector2d> points_m = stations_m;
  if (p_start_m) points_m.push_back(*p_start_m);
  GroundFlood flood(site, points_m, settings);
  if (p_start_m) {
    const Cell start = flood.grid().cell_at(*p_start_m);
    if (flood.flood_from(start) == 0)
      throw InputError(fmt::format("start ({:.2f}, {:.2f}): no ground", p_start_m->x(), p_start_m->y()));
    refuse_start_in_solid(site, {p_start_m->x(), p_start_m->y(), flood.ground_m(start) + settings.max_step_m});
    return flood.plan_of_region(flood.last_region());
  }
  const int spacing = std::max(1, static_cast<int>(kStartSpacing_m / flood.grid().resolution_m));
  std::size_t max_count = 0;
  std::int32_t largest = 0;
  for (int row = spacing / 2; row < flood.grid().height; row += spacing) {
    for (int col = spacing / 2; col < flood.grid().width; col += spacing) {
      const std::size_t count = flood.flood_from({col, row});
      if (count > max_count) max_count = count, largest = flood.last_region();
    }
  }
  if (largest == 0) throw InputError("the site has no ground");
  return flood.plan_of_region(largest);
}

}  // namespace patrol::importer
