#pragma once

#include <algorithm>

#include "core/grid.h"

namespace patrol::plan {

/// Cells from `min` up to and including `max`; empty at first.
struct CellBox {
  Cell min{1, 1};
  Cell max{0, 0};

  bool is_empty() const { return max.col < min.col; }
  int width() const { return max.col - min.col + 1; }
  int height() const { return max.row - min.row + 1; }

  void extend(Cell cell) {
    if (is_empty()) {
      min = max = cell;
      return;
    }
    min = {std::min(min.col, cell.col), std::min(min.row, cell.row)};
    max = {std::max(max.col, cell.col), std::max(max.row, cell.row)};
  }
  void merge(const CellBox& box) {
    if (box.is_empty()) return;
    extend(box.min);
    extend(box.max);
  }

  /// Box with `cells` more on each side, clipped to a grid.
  CellBox grown(int cells, const GridGeometry& within) const {
    return {.min = {std::max(0, min.col - cells), std::max(0, min.row - cells)},
            .max = {std::min(within.width - 1, max.col + cells), std::min(within.height - 1, max.row + cells)}};
  }
};

/// All cells of a grid.
inline CellBox all_cells(const GridGeometry& geometry) {
  return {.min = {0, 0}, .max = {geometry.width - 1, geometry.height - 1}};
}

}  // namespace patrol::plan
