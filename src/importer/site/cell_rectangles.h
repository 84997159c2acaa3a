#pragma once

#include <functional>
#include <vector>

#include "core/grid.h"

namespace patrol::importer {

/// Rectangle of cells of a grid.
struct CellRectangle {
  Cell begin = {};  ///< cell with the lowest column and row
  int width = 0;    ///< number of columns
  int height = 0;   ///< number of rows
};

/// Returns rectangles without overlap that cover exactly the selected cells: from the first cell in row order, the
/// rectangle of the largest area that begins there, then from the first cell that remains.
std::vector<CellRectangle> rectangles_of(const GridGeometry& grid, const std::function<bool(Cell)>& is_selected);

}  // namespace patrol::importer
