#include "importer/site/cell_rectangles.h"

#include <algorithm>

namespace patrol::importer {
namespace {

/// Returns the rectangle of the largest area with its lowest corner at `begin`, of cells that are true.
CellRectangle largest_from(const Grid<char>& open, Cell begin) {
  const GridGeometry& grid = open.geometry();
  CellRectangle best{.begin = begin, .width = 0, .height = 0};
  int max_width = grid.width - begin.col;
  for (int row = begin.row; row < grid.height; ++row) {
    int width = 0;
    while (width < max_width && open.at({begin.col + width, row}) != 0) ++width;
    if (width == 0) break;
    max_width = width;
    const int height = row - begin.row + 1;
    if (width * height > best.width * best.height) best = {.begin = begin, .width = width, .height = height};
  }
  return best;
}

}  // namespace

std::vector<CellRectangle> rectangles_of(const GridGeometry& grid, const std::function<bool(Cell)>& is_selected) {
  Grid<char> open(grid);
  for (int row = 0; row < grid.height; ++row) {
    for (int col = 0; col < grid.width; ++col) open.at({col, row}) = is_selected({col, row}) ? 1 : 0;
  }
  std::vector<CellRectangle> rectangles;
  for (int row = 0; row < grid.height; ++row) {
    for (int col = 0; col < grid.width; ++col) {
      if (open.at({col, row}) == 0) continue;
      const CellRectangle found = largest_from(open, {col, row});
      for (int r = row; r < row + found.height; ++r) {
        for (int c = col; c < col + found.width; ++c) open.at({c, r}) = 0;
      }
      rectangles.push_back(found);
    }
  }
  return rectangles;
}

}  // namespace patrol::importer
