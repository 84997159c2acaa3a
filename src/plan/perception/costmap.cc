#include "plan/perception/costmap.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include <fmt/format.h>

#include "core/error.h"
#include "plan/perception/bilinear.h"

namespace patrol::plan {
namespace {

constexpr double kGrowth_m = 5.0;  ///< added at each growth, so that growth is rare

const CostmapSettings& checked(const CostmapSettings& settings) {
  validate(settings, "costmap");
  return settings;
}

/// Throws InputError unless the cells around a position have numbers.
void require_valid_position(const Eigen::Vector2d& p_map) {
  constexpr double kMaxCoordinate_m = 1e5;
  if (!(p_map.cwiseAbs().maxCoeff() <= kMaxCoordinate_m && p_map.allFinite()))
    throw InputError(fmt::format("costmap: position ({:g}, {:g}) m: must be finite and within {:g} m", p_map.x(),
                                 p_map.y(), kMaxCoordinate_m));
}

void require_finite_yaw(const Pose2& T_map_body) {
  if (!std::isfinite(T_map_body.yaw))
    throw InputError(fmt::format("costmap: yaw {:g} rad: must be finite", T_map_body.yaw));
}

}  // namespace

Costmap::Costmap(const CostmapSettings& settings, const Footprint& footprint,
                 std::vector<Polyline> keep_out_lines_in_map)
    : settings_(checked(settings)),
      footprint_(footprint),
      static_map_(settings),
      scan_(settings),
      low_(settings.low),
      inflation_(settings, footprint),
      keep_out_(settings, std::move(keep_out_lines_in_map), inflation_.max_distance_m()) {
  include_keep_out_lines();
  include(Eigen::Vector2d::Zero(), kGrowth_m);
}

void Costmap::include_keep_out_lines() {
  for (const Polyline& line : keep_out_.lines()) {
    for (const Eigen::Vector2d& p : line) include(p, 1.0);
  }
}

void Costmap::set_keep_out_lines(std::vector<Polyline> lines_in_map) {
  keep_out_.set_lines(std::move(lines_in_map));
  include_keep_out_lines();
  keep_out_.resize(lattice_);
  refresh_costs(all_cells(lattice_.geometry));
}

void Costmap::include(const Eigen::Vector2d& p_map, double margin_m) {
  require_valid_position(p_map);
  const double res = settings_.resolution_m;
  const auto lattice = [res](double x) { return static_cast<int>(std::floor(x / res)); };
  const Cell min{lattice(p_map.x() - margin_m), lattice(p_map.y() - margin_m)};
  const Cell end{lattice(p_map.x() + margin_m) + 1, lattice(p_map.y() + margin_m) + 1};
  if (geometry().size() == 0) return resize(min, end);

  const Cell old_min = lattice_.origin;
  const Cell old_end = lattice_.to_lattice({geometry().width, geometry().height});
  const int extra = static_cast<int>(kGrowth_m / res);
  const auto low = [extra](int wanted, int now) { return wanted < now ? wanted - extra : now; };
  const auto high = [extra](int wanted, int now) { return wanted > now ? wanted + extra : now; };
  const Cell new_min{low(min.col, old_min.col), low(min.row, old_min.row)};
  const Cell new_end{high(end.col, old_end.col), high(end.row, old_end.row)};
  if (new_min != old_min || new_end != old_end) resize(new_min, new_end);
}

void Costmap::resize(Cell min, Cell end) {
  lattice_ = CellLattice(settings_.resolution_m, min, end);
  static_map_.resize(lattice_);
  scan_.resize(lattice_);
  low_.resize(lattice_);
  inflation_.resize(lattice_);
  keep_out_.resize(lattice_);
  cost_ = Grid<Cost>(lattice_.geometry, kFreeCost);
  refresh(all_cells(lattice_.geometry));
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
  refresh(static_map_.set_map(map));
}

void Costmap::add_scan(const LevelScan& scan, const Pose2& T_map_body) {
  require_finite_yaw(T_map_body);
  include(T_map_body.position(), settings_.obstacle_range_m + settings_.resolution_m);
  refresh(scan_.add_scan(scan, T_map_body, static_map_));
}

void Costmap::add_image(const DepthPoints& points, Time stamp, const Pose2& T_map_body) {
  require_finite_yaw(T_map_body);
  include(T_map_body.position(), settings_.obstacle_range_m);
  refresh(low_.add_image(points, stamp, T_map_body, scan_));
}

void Costmap::add_ping(const SonarCone& cone, Time stamp, const Pose2& T_map_body) {
  require_finite_yaw(T_map_body);
  include(T_map_body.position(), settings_.obstacle_range_m);
  refresh(low_.add_ping(cone, stamp, T_map_body, scan_, static_map_));
}

void Costmap::clear_obstacles(const Eigen::Vector2d& p_map, double radius_m) {
  CellBoxes changed = low_.clear_sonar(p_map, radius_m);
  changed.merge(scan_.clear(p_map, radius_m));
  refresh(changed);
}

void Costmap::refresh(const CellBox& changed) {
  if (changed.is_empty()) return;
  refresh_costs(inflation_.update(changed, [this](Cell first, int count, std::uint8_t* is_obstacle) {
    static_map_.mark_obstacles(first, count, is_obstacle);
    scan_.mark_obstacles(first, count, is_obstacle);
    low_.mark_obstacles(first, count, is_obstacle);
  }));
}

void Costmap::refresh_costs(const CellBox& target) {
  for (int row = target.min.row; row <= target.max.row; ++row) {
    const Cell first{target.min.col, row};
    Cost* cost = &cost_.at(first);
    inflation_.set_costs(first, target.width(), cost);
    static_map_.raise_costs(first, target.width(), cost);
    keep_out_.raise_costs(first, target.width(), cost);
  }
}

Cost Costmap::cost_at(const Eigen::Vector2d& p_map) const {
  const Cell cell = geometry().cell_at(p_map);
  return cost_.contains(cell) ? cost_.at(cell) : static_map_.unknown_cost();
}

// Without lines, the distance to a line is at least max_distance_m() beyond the margin, which no obstacle exceeds.
double Costmap::clearance_m(const Pose2& T_map_body) const {
  const double c = std::cos(T_map_body.yaw), s = std::sin(T_map_body.yaw);
  const bool has_lines = !keep_out_.lines().empty();
  double clearance = std::numeric_limits<double>::infinity();
  for (const Disc& disc : footprint_.discs()) {
    const Eigen::Vector2d p_map(T_map_body.x + c * disc.center_m.x() - s * disc.center_m.y(),
                                T_map_body.y + s * disc.center_m.x() + c * disc.center_m.y());
    const BilinearCell at(geometry(), p_map);
    clearance = std::min(clearance, inflation_.distance_m(at) - disc.radius_m - settings_.safety_margin_m);
    if (has_lines) clearance = std::min(clearance, keep_out_.distance_m(at) - settings_.keep_out_margin_m);
  }
  return clearance;
}

bool Costmap::is_clear(const Pose2& T_map_body, double margin_m) const {
  double reach_m = 0.0, center_reach_m = 0.0;  // of the discs and of their centers from the body origin
  for (const Disc& disc : footprint_.discs()) {
    center_reach_m = std::max(center_reach_m, disc.center_m.norm());
    reach_m = std::max(reach_m, disc.center_m.norm() + disc.radius_m);
  }
  const Eigen::Vector2d p_map = T_map_body.position();
  if (obstacle_distance_m(p_map) - reach_m - settings_.safety_margin_m > margin_m &&
      keep_out_distance_m(p_map) - center_reach_m - settings_.keep_out_margin_m > margin_m) {
    return true;
  }
  return clearance_m(T_map_body) > margin_m;
}

}  // namespace patrol::plan
