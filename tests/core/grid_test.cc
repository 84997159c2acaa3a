#include "core/grid.h"

#include <gtest/gtest.h>

#include "tests/support/pose_near.h"

namespace patrol::grid_test {
namespace {

using test::VectorNear;

const GridGeometry kGeometry{.resolution_m = 0.5, .width = 4, .height = 3, .origin_m = {-1.0, 10.0}};

TEST(GridGeometry, CellZeroHasItsLowerLeftCornerAtTheOrigin) {
  EXPECT_EQ(kGeometry.cell_at({-1.0, 10.0}), (Cell{0, 0}));
  EXPECT_EQ(kGeometry.cell_at({-0.51, 10.49}), (Cell{0, 0}));
  EXPECT_EQ(kGeometry.cell_at({-0.5, 10.5}), (Cell{1, 1}));
  EXPECT_THAT(kGeometry.center_of({0, 0}), VectorNear(Eigen::Vector2d(-0.75, 10.25), 1e-12));
}

TEST(GridGeometry, CellsBelowTheOriginAreNegativeAndOutside) {
  EXPECT_EQ(kGeometry.cell_at({-1.01, 9.99}), (Cell{-1, -1}));
  EXPECT_FALSE(kGeometry.contains({-1, 0}));
  EXPECT_FALSE(kGeometry.contains({0, 3}));
  EXPECT_FALSE(kGeometry.contains({4, 0}));
  EXPECT_TRUE(kGeometry.contains({3, 2}));
}

TEST(GridGeometry, EveryCentreLiesInItsCell) {
  for (int row = 0; row < kGeometry.height; ++row) {
    for (int col = 0; col < kGeometry.width; ++col) {
      EXPECT_EQ(kGeometry.cell_at(kGeometry.center_of({col, row})), (Cell{col, row}));
    }
  }
}

TEST(Grid, LiesRowByRowFromLowY) {
  Grid<int> grid(kGeometry, 7);
  ASSERT_EQ(grid.values().size(), 12U);
  grid.at({3, 0}) = 1;
  grid.at({0, 1}) = 2;
  EXPECT_EQ(grid.values()[3], 1);
  EXPECT_EQ(grid.values()[4], 2);
  EXPECT_EQ(grid.values()[11], 7);
}

TEST(Grid, WithoutSizeHoldsNothing) {
  const OccupancyGrid grid;
  EXPECT_TRUE(grid.values().empty());
  EXPECT_FALSE(grid.contains({0, 0}));
}

}  // namespace
}  // namespace patrol::grid_test
