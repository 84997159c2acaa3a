#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "core/messages.h"
#include "plan/perception/cell_box.h"
#include "plan/perception/cell_lattice.h"
#include "plan/perception/costmap_settings.h"
#include "plan/perception/static_map_layer.h"

namespace patrol::plan {

/// Costmap layer of lidar hits that the static map does not have (yet). A hit is cleared when a later beam passes
/// beyond it, when the map has it, or when it has not been observed for `obstacle_persistence_s`.
class ScanLayer {
 public:
  explicit ScanLayer(const CostmapSettings& settings) : settings_(settings) {}

  void resize(const CellLattice& lattice);
  /// Clears and marks obstacles; returns the cells that change.
  CellBoxes add_scan(const LevelScan& scan, const Pose2& T_map_body, const StaticMapLayer& map);
  /// Clears all obstacles within a radius; returns their cells.
  CellBoxes clear(const Eigen::Vector2d& p_map, double radius_m);

  /// Whether a cell inside the grid is an obstacle.
  bool is_obstacle(Cell cell) const { return index_.at(cell) != 0; }
  /// Sets the flags of the obstacles among `count` cells of a row.
  void mark_obstacles(Cell first, int count, std::uint8_t* is_obstacle) const;
  bool contains_obstacle(Cell cell) const { return index_.contains(cell) && is_obstacle(cell); }
  /// Whether an obstacle lies at most `radius_cells` columns and rows from a cell, which may be outside the grid.
  bool has_obstacle_near(Cell cell, int radius_cells) const;
  /// Time of the first observation of the oldest obstacle within a radius; none without obstacles.
  std::optional<Time> first_seen(const Eigen::Vector2d& p_map, double radius_m) const;
  std::size_t num_obstacles() const { return obstacles_.size(); }

  template <typename Archive>
  void serialize_state(Archive& archive) {
    archive(lattice_, index_, obstacles_);
  }

 private:
  struct Obstacle {
    Cell lattice;
    Time seen{};
    Time first_seen{};
  };

  Cell to_cell(const Obstacle& obstacle) const { return lattice_.to_grid(obstacle.lattice); }
  void clear_passed(const LevelScan& scan, const Pose2& T_map_body, const StaticMapLayer& map, CellBoxes& changed);
  void mark_hits(const LevelScan& scan, const Pose2& T_map_body, const StaticMapLayer& map, CellBoxes& changed);

  CostmapSettings settings_;
  CellLattice lattice_;
  Grid<std::uint32_t> index_;  ///< 1 + index in obstacles_, 0 without an obstacle
  std::vector<Obstacle> obstacles_;
};

}  // namespace patrol::plan
