#include "importer/grid/height_grid.h"

#include <gtest/gtest.h>

#include "importer/grid/cell_regions.h"
#include "importer/grid/triangle_cells.h"

namespace patrol::importer {
namespace {

const GridGeometry kGrid{.resolution_m = 0.5, .width = 12, .height = 9, .origin_m = {-1.0, 2.0}};

Grid<char> marked_at(Cell cell) {
  Grid<char> marked(kGrid, 0);
  marked.at(cell) = 1;
  return marked;
}

TEST(HeightGrid, InterpolatesALinearSurfaceExactlyAndEndsAtTheOutermostCenters) {
  Grid<float> heights(kGrid);
  for (int row = 0; row < kGrid.height; ++row) {
    for (int col = 0; col < kGrid.width; ++col) {
      const Eigen::Vector2d p = kGrid.center_of({col, row});
      heights.at({col, row}) = static_cast<float>(0.25 * p.x() - 0.5 * p.y() + 3.0);
    }
  }
  EXPECT_NEAR(interpolated(heights, {1.37, 4.11}), 0.25 * 1.37 - 0.5 * 4.11 + 3.0, 1e-6);
  EXPECT_NEAR(interpolated(heights, {-9.0, 4.11}), 0.25 * -0.75 - 0.5 * 4.11 + 3.0, 1e-6);
}

TEST(HeightGrid, FillKeepsKnownCellsAndStaysWithinTheirRange) {
  Grid<float> values(kGrid, 7.0f);
  Grid<char> known(kGrid, 0);
  values.at({2, 2}) = 1.0f;
  values.at({9, 6}) = 2.0f;
  known.at({2, 2}) = known.at({9, 6}) = 1;
  fill_smoothly(values, known);
  EXPECT_EQ(values.at({2, 2}), 1.0f);
  EXPECT_EQ(values.at({9, 6}), 2.0f);
  for (const float value : values.values()) {
    EXPECT_GE(value, 1.0f);
    EXPECT_LE(value, 2.0f);
  }
  EXPECT_LT(values.at({2, 3}), values.at({9, 5}));
}

TEST(CellRegions, DilationOfOneCellIsASquare) {
  const Grid<char> square = dilated(marked_at({5, 4}), 2);
  int count = 0;
  for (int row = 0; row < kGrid.height; ++row) {
    for (int col = 0; col < kGrid.width; ++col) {
      const bool is_inside = std::abs(col - 5) <= 2 && std::abs(row - 4) <= 2;
      EXPECT_EQ(square.at({col, row}) != 0, is_inside);
      count += square.at({col, row});
    }
  }
  EXPECT_EQ(count, 25);
}

TEST(CellRegions, CellsInsideOfARingAreNotOuter) {
  Grid<char> ring = dilated(marked_at({5, 4}), 2);
  for (int row = 3; row <= 5; ++row) {
    for (int col = 4; col <= 6; ++col) ring.at({col, row}) = 0;
  }
  const Grid<char> outer = outer_cells(ring);
  EXPECT_EQ(std::count(outer.values().begin(), outer.values().end(), 1), 12 * 9 - 25);
  EXPECT_EQ(outer.at({5, 4}), 0);
}

TEST(TriangleCells, CentersInsideHaveTheHeightOfThePlane) {
  int count = 0;
  // Half of the square from (-1, 2) to (3, 6): its diagonal crosses the centers of 8 cells, 28 are below it.
  visit_cell_centers({Eigen::Vector3d(-1.0, 2.0, 1.0), Eigen::Vector3d(3.0, 2.0, 3.0), Eigen::Vector3d(3.0, 6.0, 3.0)},
                     kGrid, [&](Cell cell, double z) {
                       ++count;
                       EXPECT_NEAR(z, 1.0 + 0.5 * (kGrid.center_of(cell).x() + 1.0), 1e-9);
                     });
  EXPECT_EQ(count, 36);
  visit_cell_centers({Eigen::Vector3d(-1.0, 2.0, 1.0), Eigen::Vector3d(3.0, 2.0, 3.0), Eigen::Vector3d(3.0, 2.0, 5.0)},
                     kGrid, [&](Cell, double) { ADD_FAILURE(); });
}

}  // namespace
}  // namespace patrol::importer
