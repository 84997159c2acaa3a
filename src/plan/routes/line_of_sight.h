#pragma once

#include <array>
#include <cstdlib>
#include <optional>

#include "core/grid.h"
#include "plan/perception/costmap.h"

namespace patrol::plan {

/// Follows the straight line between two cell centers and calls `visit(cell, fraction)` for every cell whose closed
/// square it meets, in order. `fraction` is the part of the line inside; 0 for cells that it only touches at a corner.
/// Exact in integers. Stops, and returns false, as soon as `visit` does.
template <typename Visit>
bool visit_line_cells(Cell from, Cell to, Visit&& visit) {
  const int step_col = to.col > from.col ? 1 : -1, step_row = to.row > from.row ? 1 : -1;
  const long dx = std::abs(to.col - from.col), dy = std::abs(to.row - from.row);
  Cell cell = from;
  double done = 0.0;  // fraction of the line before it enters the cell
  // The next side crossed is at the fraction (2 i + 1) / (2 dx) of the line for columns, (2 j + 1) / (2 dy) for rows,
  // after i columns and j rows.
  long along_col = dy, along_row = dx;              // (2 i + 1) dy and (2 j + 1) dx
  double col_numerator = 1.0, row_numerator = 1.0;  // 2 i + 1 and 2 j + 1
  const double col_denominator = 2.0 * static_cast<double>(dx), row_denominator = 2.0 * static_cast<double>(dy);
  while (cell != to) {
    const bool crosses_col = dx > 0 && along_col <= along_row, crosses_row = dy > 0 && along_row <= along_col;
    const double next = crosses_col ? col_numerator / col_denominator : row_numerator / row_denominator;
    if (!visit(cell, next - done)) return false;
    done = next;
    if (crosses_col && crosses_row) {
      if (!visit(Cell{cell.col + step_col, cell.row}, 0.0) || !visit(Cell{cell.col, cell.row + step_row}, 0.0))
        return false;
    }
    if (crosses_col) cell.col += step_col, along_col += 2 * dy, col_numerator += 2.0;
    if (crosses_row) cell.row += step_row, along_row += 2 * dx, row_numerator += 2.0;
  }
  return visit(cell, 1.0 - done);
}

/// Cost of the straight line between two cell centers, cells: its length, each part weighted by its cell's factor. None
/// without line of sight: the line meets a lethal cell, or only a corner of one. For neighbors this is is_valid_step's
/// rule. Both cells are in the grid.
std::optional<double> line_cost(const Grid<Cost>& costs, const std::array<double, 256>& factors, Cell from, Cell to);

}  // namespace patrol::plan
