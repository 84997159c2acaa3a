#pragma once

#include <cstdint>
#include <vector>

#include "plan/perception/cell_box.h"
#include "plan/perception/cell_lattice.h"
#include "plan/perception/depth_obstacles.h"
#include "plan/perception/low_obstacles.h"
#include "plan/perception/scan_layer.h"
#include "plan/perception/sonar_cone.h"
#include "plan/perception/static_map_layer.h"

namespace patrol::plan {

/// Costmap layer of obstacles below the lidar's plane, from the depth camera and the ultrasonic ring (low_obstacles.h).
class LowObstacleLayer {
 public:
  explicit LowObstacleLayer(const LowObstaclesSettings& settings) : settings_(settings), low_(settings) {}

  void resize(const CellLattice& lattice);
  /// Adds the points of a depth image, in level at its stamp; returns the cells that change. Obstacles near those of
  /// the scan layer have the shorter persistence of moving obstacles.
  CellBoxes add_image(const DepthPoints& points, Time stamp, const Pose2& T_map_body, const ScanLayer& scan);
  /// Adds a ping, in level at its stamp; returns the cells that change. Echoes near obstacles of the other layers are
  /// ignored.
  CellBoxes add_ping(const SonarCone& cone, Time stamp, const Pose2& T_map_body, const ScanLayer& scan,
                     const StaticMapLayer& map);
  /// Discards the evidence of sonar within a radius; returns the cells that change.
  CellBoxes clear_sonar(const Eigen::Vector2d& p_map, double radius_m);

  /// Whether a cell inside the grid is an obstacle.
  bool is_obstacle(Cell cell) const { return is_low_.at(cell) != 0; }
  /// Sets the flags of the obstacles among `count` cells of a row.
  void mark_obstacles(Cell first, int count, std::uint8_t* is_obstacle) const;
  bool contains_obstacle(Cell cell) const { return is_low_.contains(cell) && is_obstacle(cell); }
  std::size_t num_obstacles() const { return low_.num_obstacles(); }

  template <typename Archive>
  void serialize_state(Archive& archive) {
    archive(lattice_, low_, is_low_);
  }

 private:
  /// Lattice cells inside the grid with at least `min_count` of the points.
  std::vector<Cell> lattice_cells(const std::vector<Eigen::Vector2d>& p_level, const Pose2& T_map_body,
                                  int min_count) const;
  CellBoxes apply_changes();

  LowObstaclesSettings settings_;
  CellLattice lattice_;
  LowObstacles low_;           ///< evidence on the lattice
  Grid<std::uint8_t> is_low_;  ///< obstacles of `low_`, for fast look-up
};

}  // namespace patrol::plan
