#pragma once

#include "plan/perception/cell_box.h"
#include "plan/perception/cell_lattice.h"
#include "plan/perception/cost.h"
#include "plan/perception/costmap_settings.h"

namespace patrol::plan {

/// Costmap layer of the occupancy grid from SLAM or from a file, max-pooled to the costmap's cells.
class StaticMapLayer {
 public:
  explicit StaticMapLayer(const CostmapSettings& settings);

  /// Copies the map to the new lattice, which must contain the old one.
  void resize(const CellLattice& lattice);
  /// Replaces the map; returns the cells that change. The map must lie inside the lattice and have cells at most as
  /// large.
  CellBox set_map(const OccupancyGrid& map);

  bool is_obstacle(Cell cell) const { return map_.at(cell) >= occupied_percent_; }
  /// Sets the flags of the obstacles among `count` cells of a row.
  void mark_obstacles(Cell first, int count, std::uint8_t* is_obstacle) const;
  /// Whether an obstacle lies at most `radius_cells` columns and rows from a cell, which may be outside the grid.
  bool has_obstacle_near(Cell cell, int radius_cells) const;
  /// Cost of a cell that is unknown in the map.
  Cost unknown_cost() const { return unknown_cost_; }
  /// Raises the costs of `count` cells of a row to those of unknown cells.
  void raise_costs(Cell first, int count, Cost* cost) const;

  template <typename Archive>
  void serialize_state(Archive& archive) {
    archive(lattice_, map_);
  }

 private:
  OccupancyGrid pooled(const OccupancyGrid& map) const;

  int occupied_percent_;
  Cost unknown_cost_;
  CellLattice lattice_;
  OccupancyGrid map_;
};

}  // namespace patrol::plan
