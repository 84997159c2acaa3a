#pragma once

#include <cstdint>
#include <vector>

#include "core/geometry/distance_transform.h"
#include "plan/perception/bilinear.h"
#include "plan/perception/cell_box.h"
#include "plan/perception/cell_lattice.h"
#include "plan/perception/cost.h"
#include "plan/perception/costmap_settings.h"
#include "plan/perception/footprint.h"

namespace patrol::plan {

/// Costmap layer that inflates obstacles by their exact distance: lethal where the robot's inscribed circle would be in
/// collision, then falling exponentially.
class InflationLayer {
 public:
  /// Throws InputError if the lethal distance lies beyond the cap of the distance transform.
  InflationLayer(const CostmapSettings& settings, const Footprint& footprint);

  /// Resets the layer to a lattice without obstacles.
  void resize(const CellLattice& lattice);
  /// Updates the distances around cells that have changed; returns the cells whose distance may change. `mark(first,
  /// count, is_obstacle)` sets the flags of the obstacles among `count` cells of a row, and leaves the others.
  template <typename Mark>
  CellBox update(const CellBox& changed, const Mark& mark) {
    // Distances change up to the cap around the changed cells, and depend on obstacles up to the cap around those.
    const CellBox window = changed.grown(2 * transform_.cap_cells(), squared_.geometry());
    is_obstacle_.assign(static_cast<std::size_t>(window.width()) * static_cast<std::size_t>(window.height()), 0);
    std::uint8_t* is_obstacle = is_obstacle_.data();
    for (int row = window.min.row; row <= window.max.row; ++row, is_obstacle += window.width())
      mark(Cell{window.min.col, row}, window.width(), is_obstacle);
    const CellBox target = changed.grown(transform_.cap_cells(), squared_.geometry());
    update_distances(window, target);
    return target;
  }

  /// Distance to the nearest obstacle's surface, interpolated between cells; at most `max_distance_m`.
  double distance_m(const Eigen::Vector2d& p_map) const;
  /// Interpolated distance at a position in the layer's lattice.
  double distance_m(const BilinearCell& at) const;
  double max_distance_m() const { return distance_of_.back(); }
  /// Sets the costs of `count` cells of a row.
  void set_costs(Cell first, int count, Cost* cost) const;

  template <typename Archive>
  void serialize_state(Archive& archive) {
    archive(squared_);
  }

 private:
  /// Computes the distances of the cells of `target` from the obstacles in `window`.
  void update_distances(const CellBox& window, const CellBox& target);

  DistanceTransform transform_;
  std::vector<double> distance_of_;  ///< [squared cells], distance to the obstacle's surface, m
  std::vector<Cost> cost_of_;        ///< [squared cells]
  Grid<std::int16_t> squared_;       ///< squared distance to the nearest obstacle, cells

  std::vector<std::uint8_t> is_obstacle_;  ///< obstacle cells in the window of an update, row by row
  DistanceTransform::SquaredDistances target_squared_;
};

}  // namespace patrol::plan
