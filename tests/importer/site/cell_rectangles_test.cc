#include "importer/site/cell_rectangles.h"

#include <gtest/gtest.h>

#include "core/random.h"

namespace patrol::importer::cell_rectangles_test {
namespace {

TEST(CellRectangles, AnLOfFiveCellsIsTwoRectangles) {
  const GridGeometry grid{.width = 3, .height = 3};
  const auto is_selected = [](Cell cell) { return cell.col == 0 || cell.row == 0; };
  const std::vector<CellRectangle> found = rectangles_of(grid, is_selected);
  ASSERT_EQ(found.size(), 2u);
  EXPECT_EQ(found[0].width * found[0].height + found[1].width * found[1].height, 5);
}

TEST(CellRectangles, CoverTwentyRandomPatternsExactlyOnce) {
  const GridGeometry grid{.width = 31, .height = 17};
  for (std::uint64_t pattern = 0; pattern < 20; ++pattern) {
    const RandomStream stream(pattern, "cells");
    const auto is_selected = [&](Cell cell) {
      return stream.uniform(static_cast<std::uint64_t>(cell.row * grid.width + cell.col)) < 0.6;
    };
    Grid<int> covered(grid);
    for (const CellRectangle& part : rectangles_of(grid, is_selected)) {
      for (int row = part.begin.row; row < part.begin.row + part.height; ++row) {
        for (int col = part.begin.col; col < part.begin.col + part.width; ++col) ++covered.at({col, row});
      }
    }
    for (int row = 0; row < grid.height; ++row) {
      for (int col = 0; col < grid.width; ++col)
        ASSERT_EQ(covered.at({col, row}), is_selected({col, row}) ? 1 : 0) << pattern;
    }
  }
}

}  // namespace
}  // namespace patrol::importer::cell_rectangles_test
