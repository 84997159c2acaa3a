#include "importer/grid/cell_regions.h"

#include <vector>

namespace patrol::importer {
namespace {

/// Marks the cells of a line within `reach` of a marked one. `at(i)` is the cell i of `count`.
template <typename At>
void dilate_line(const Grid<char>& marked, Grid<char>& result, int count, int reach, At at) {
  for (int i = 0, last = -reach - 1; i < count; ++i) {
    if (marked.at(at(i)) != 0) last = i;
    if (i - last <= reach) result.at(at(i)) = 1;
  }
  for (int i = count - 1, last = count + reach; i >= 0; --i) {
    if (marked.at(at(i)) != 0) last = i;
    if (last - i <= reach) result.at(at(i)) = 1;
  }
}

}  // namespace

Grid<char> dilated(const Grid<char>& marked, int reach) {
  const GridGeometry& grid = marked.geometry();
  Grid<char> along_rows(grid, 0), result(grid, 0);
  for (int row = 0; row < grid.height; ++row)
    dilate_line(marked, along_rows, grid.width, reach, [&](int i) { return Cell{i, row}; });
  for (int col = 0; col < grid.width; ++col)
    dilate_line(along_rows, result, grid.height, reach, [&](int i) { return Cell{col, i}; });
  return result;
}

Grid<char> outer_cells(const Grid<char>& marked) {
  const GridGeometry& grid = marked.geometry();
  Grid<char> outer(grid, 0);
  std::vector<Cell> open;
  const auto visit = [&](Cell cell) {
    if (!grid.contains(cell) || marked.at(cell) != 0 || outer.at(cell) != 0) return;
    outer.at(cell) = 1;
    open.push_back(cell);
  };
  for (int col = 0; col < grid.width; ++col) {
    visit({col, 0});
    visit({col, grid.height - 1});
  }
  for (int row = 0; row < grid.height; ++row) {
    visit({0, row});
    visit({grid.width - 1, row});
  }
  while (!open.empty()) {
    const Cell at = open.back();
    open.pop_back();
    visit({at.col + 1, at.row});
    visit({at.col - 1, at.row});
    visit({at.col, at.row + 1});
    visit({at.col, at.row - 1});
  }
  return outer;
}

}  // namespace patrol::importer
