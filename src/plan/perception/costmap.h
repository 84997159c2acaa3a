#pragma once

#include <optional>
#include <vector>

#include "core/frames.h"
#include "core/grid.h"
#include "core/messages.h"
#include "plan/perception/cell_box.h"
#include "plan/perception/cell_lattice.h"
#include "plan/perception/cost.h"
#include "plan/perception/costmap_settings.h"
#include "plan/perception/footprint.h"
#include "plan/perception/inflation_layer.h"
#include "plan/perception/keep_out_layer.h"
#include "plan/perception/low_obstacle_layer.h"
#include "plan/perception/scan_layer.h"
#include "plan/perception/static_map_layer.h"

namespace patrol::plan {

inline constexpr double kMinPassable_m = 0.02;  ///< clearance of a safe motion

/// Layered costmap in `map`, as in Nav2. Each layer has its own file, this class combines them.
///
///   StaticMapLayer    occupancy grid of SLAM or of a file;
///   ScanLayer         lidar hits that the map does not have (yet);
///   LowObstacleLayer  obstacles below the lidar's plane, from the depth camera and the ultrasonic ring;
///   InflationLayer    distances to the obstacles of these three, and their costs;
///   KeepOutLayer      surveyed lines that the lidar cannot see.
///
/// The cost of a cell is the maximum over its layers. A change updates only its neighborhood. Cells lie on multiples of
/// the resolution, so that the costmap can grow without moving.
class Costmap {
 public:
  Costmap(const CostmapSettings& settings, const Footprint& footprint, std::vector<Polyline> keep_out_lines_in_map);

  /// Throws InputError if the map's cells are larger than the costmap's.
  void set_map(const OccupancyGrid& map);
  /// Replaces the keep-out lines and refreshes all cells.
  void set_keep_out_lines(std::vector<Polyline> lines_in_map);
  /// Throws InputError if the pose is not finite or beyond 100 km, as the functions for images and pings.
  void add_scan(const LevelScan& scan, const Pose2& T_map_body);
  /// Adds the points of a depth image, in level at its stamp.
  void add_image(const DepthPoints& points, Time stamp, const Pose2& T_map_body);
  /// Adds the cone of a ping, in level at its stamp.
  void add_ping(const SonarCone& cone, Time stamp, const Pose2& T_map_body);
  /// Clears the obstacles of the scan layer within a radius, and the evidence of sonar; later messages mark them again.
  void clear_obstacles(const Eigen::Vector2d& p_map, double radius_m);
  /// Grows the grid, if needed, so that the square of half-width `margin_m` around the point lies inside.
  /// Throws InputError if the point is not finite or beyond 100 km.
  void include(const Eigen::Vector2d& p_map, double margin_m);

  const CostmapSettings& settings() const { return settings_; }
  const Footprint& footprint() const { return footprint_; }
  const GridGeometry& geometry() const { return cost_.geometry(); }
  const Grid<Cost>& cost() const { return cost_; }
  /// Cost at a point; outside the grid, the cost of unknown cells.
  Cost cost_at(const Eigen::Vector2d& p_map) const;
  bool is_scan_obstacle(Cell cell) const { return scan_.contains_obstacle(cell); }
  /// Time of the first observation of the oldest scan obstacle within a radius; none without obstacles.
  std::optional<Time> obstacle_first_seen(const Eigen::Vector2d& p_map, double radius_m) const {
    return scan_.first_seen(p_map, radius_m);
  }
  std::size_t num_scan_obstacles() const { return scan_.num_obstacles(); }
  bool is_low_obstacle(Cell cell) const { return low_.contains_obstacle(cell); }
  std::size_t num_low_obstacles() const { return low_.num_obstacles(); }

  /// Distance to the nearest obstacle's surface, interpolated between cells; at most `max_distance_m`.
  double obstacle_distance_m(const Eigen::Vector2d& p_map) const { return inflation_.distance_m(p_map); }
  /// Distance to the nearest keep-out line, interpolated between cells; at most margin + `max_distance_m`.
  double keep_out_distance_m(const Eigen::Vector2d& p_map) const { return keep_out_.distance_m(p_map); }
  /// Clearance around the robot's outline, from obstacles and keep-out lines; negative in collision.
  double clearance_m(const Pose2& T_map_body) const;
  /// Returns whether the clearance exceeds a margin. Faster than `clearance_m` far from obstacles; there, the
  /// interpolation of distances may differ by a fraction of a cell.
  bool is_clear(const Pose2& T_map_body, double margin_m) const;
  double max_distance_m() const { return inflation_.max_distance_m(); }

  template <typename Archive>
  void serialize_state(Archive& archive) {
    archive(lattice_, static_map_, scan_, low_, inflation_, keep_out_, cost_);
  }

 private:
  /// Moves all layers to a new lattice, from the lattice cell `min` up to, but without, `end`.
  void resize(Cell min, Cell end);
  /// Combines the layers around cells whose obstacles have changed.
  void refresh(const CellBox& changed);
  void refresh(const CellBoxes& changed) {
    for (const CellBox& box : changed.boxes()) refresh(box);
  }
  /// Combines the costs of the layers.
  void refresh_costs(const CellBox& target);
  void include_keep_out_lines();

  CostmapSettings settings_;
  Footprint footprint_;
  CellLattice lattice_;
  StaticMapLayer static_map_;
  ScanLayer scan_;
  LowObstacleLayer low_;
  InflationLayer inflation_;
  KeepOutLayer keep_out_;
  Grid<Cost> cost_;
};

}  // namespace patrol::plan
