#pragma once

#include "core/grid.h"

namespace patrol::plan {

/// Grid of a costmap, whose cells lie on multiples of the resolution. Lattice cells are counted from the map's origin
/// and are unchanged when the grid grows; grid cells are counted from the grid's corner.
struct CellLattice {
  GridGeometry geometry{.width = 0, .height = 0};
  Cell origin;  ///< lattice cell of the grid cell (0, 0)

  CellLattice() = default;
  /// Grid from the lattice cell `min` up to, but without, `end`.
  CellLattice(double resolution_m, Cell min, Cell end)
      : geometry{.resolution_m = resolution_m,
                 .width = end.col - min.col,
                 .height = end.row - min.row,
                 .origin_m = resolution_m * Eigen::Vector2d(min.col, min.row)},
        origin(min) {}

  Cell to_grid(Cell lattice) const { return {lattice.col - origin.col, lattice.row - origin.row}; }
  Cell to_lattice(Cell grid) const { return {grid.col + origin.col, grid.row + origin.row}; }

  template <typename Archive>
  void serialize_state(Archive& archive) {
    archive(geometry, origin);
  }
};

/// Whether a predicate holds for any cell at most `radius_cells` columns and rows away.
template <typename Predicate>
bool any_cell_near(Cell center, int radius_cells, const Predicate& predicate) {
  for (int row = center.row - radius_cells; row <= center.row + radius_cells; ++row) {
    for (int col = center.col - radius_cells; col <= center.col + radius_cells; ++col) {
      if (predicate(Cell{col, row})) return true;
    }
  }
  return false;
}

}  // namespace patrol::plan
