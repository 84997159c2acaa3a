#include "score/distance_field.h"

#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

#include "core/random.h"
#include "tests/support/pose_near.h"

namespace patrol::score::distance_field_test {
namespace {

using test::VectorNear;

constexpr double kFloatTol = 1e-6;  // distances are kept as float

/// About one cell in `sparsity` occupied.
Grid<std::uint8_t> make_random(int width, int height, double sparsity, std::uint64_t seed) {
  Grid<std::uint8_t> grid({.resolution_m = 0.1, .width = width, .height = height, .origin_m = {-2.0, 5.0}});
  const RandomStream stream(seed, "test/grid");
  for (std::size_t i = 0; i < grid.values().size(); ++i) grid.values()[i] = stream.uniform(i) * sparsity < 1.0 ? 1 : 0;
  grid.values()[grid.values().size() / 2] = 1;  // never none
  return grid;
}

double brute_force_m(const Grid<std::uint8_t>& grid, const Eigen::Vector2d& p) {
  double nearest = std::numeric_limits<double>::infinity();
  for (int row = 0; row < grid.geometry().height; ++row) {
    for (int col = 0; col < grid.geometry().width; ++col) {
      if (grid.at({col, row}) != 0) nearest = std::min(nearest, (grid.geometry().center_of({col, row}) - p).norm());
    }
  }
  return nearest;
}

TEST(DistanceField, IsExactAtEveryCellCentre) {
  for (const double sparsity : {2.0, 20.0, 1e9}) {
    for (const auto& [width, height] : {std::pair{40, 25}, std::pair{1, 30}, std::pair{30, 1}, std::pair{1, 1}}) {
      const Grid<std::uint8_t> grid = make_random(width, height, sparsity, 1);
      const DistanceField field(grid);
      for (int row = 0; row < height; ++row) {
        for (int col = 0; col < width; ++col) {
          const Eigen::Vector2d p = grid.geometry().center_of({col, row});
          ASSERT_NEAR(field.distance_m(p), brute_force_m(grid, p), kFloatTol) << col << ' ' << row;
        }
      }
    }
  }
}

// Least right where two occupied cells are equally near: there the distance has a ridge that interpolation
// cuts off.
TEST(DistanceField, BetweenCentresIsWithinHalfACell) {
  const Grid<std::uint8_t> grid = make_random(40, 25, 50.0, 2);
  const DistanceField field(grid);
  const RandomStream stream(3, "test/points");
  for (std::uint64_t i = 0; i < 500; ++i) {
    const Eigen::Vector2d p(-1.9 + 3.8 * stream.uniform(i, 0), 5.1 + 2.3 * stream.uniform(i, 1));
    EXPECT_NEAR(field.distance_m(p), brute_force_m(grid, p), 0.05) << p.transpose();
  }
}

TEST(DistanceField, OutsideAddsTheWayToTheGrid) {
  Grid<std::uint8_t> grid({.resolution_m = 1.0, .width = 5, .height = 1, .origin_m = {0.0, 0.0}});
  grid.at({2, 0}) = 1;
  const DistanceField field(grid);
  EXPECT_NEAR(field.distance_m({2.5, 0.5}), 0.0, kFloatTol);
  EXPECT_NEAR(field.distance_m({3.0, 0.5}), 0.5, kFloatTol);
  EXPECT_NEAR(field.distance_m({9.5, 0.5}), 7.0, kFloatTol);  // 5 to the last centre, 2 from there
  EXPECT_NEAR(field.distance_m({2.5, -3.5}), 4.0, kFloatTol);
}

TEST(DistanceField, WithoutAnyOccupiedCellIsInfinite) {
  EXPECT_TRUE(std::isinf(DistanceField(Grid<std::uint8_t>({.width = 3, .height = 2})).distance_m({0.0, 0.0})));
  EXPECT_TRUE(std::isinf(DistanceField(Grid<std::uint8_t>()).distance_m({0.0, 0.0})));
}

TEST(DistanceField, GradientPointsAwayFromTheWallWithSlopeOne) {
  Grid<std::uint8_t> grid({.resolution_m = 0.1, .width = 40, .height = 40});
  for (int row = 0; row < 40; ++row) grid.at({10, row}) = 1;
  const DistanceField field(grid);
  EXPECT_THAT(field.gradient({2.03, 1.77}), VectorNear(Eigen::Vector2d(1.0, 0.0), 1e-5));
  EXPECT_THAT(field.gradient({0.42, 1.77}), VectorNear(Eigen::Vector2d(-1.0, 0.0), 1e-5));
  EXPECT_THAT(field.gradient({1.051, 1.77}), VectorNear(Eigen::Vector2d(1.0, 0.0), 1e-5)) << "a millimetre from it too";
}

TEST(DistanceField, GradientIsTheNumericalDerivativeInsideAndOutside) {
  const Grid<std::uint8_t> grid = make_random(40, 25, 50.0, 2);
  const DistanceField field(grid);
  const RandomStream stream(4, "test/points");
  constexpr double kStep_m = 1e-5;
  for (std::uint64_t i = 0; i < 300; ++i) {
    const Eigen::Vector2d p(-3.0 + 6.0 * stream.uniform(i, 0), 4.0 + 5.0 * stream.uniform(i, 1));
    const Eigen::Vector2d dx(kStep_m, 0.0), dy(0.0, kStep_m);
    const Eigen::Vector2d numeric(field.distance_m(p + dx) - field.distance_m(p - dx),
                                  field.distance_m(p + dy) - field.distance_m(p - dy));
    EXPECT_THAT(field.gradient(p), VectorNear(Eigen::Vector2d(numeric / (2.0 * kStep_m)), 1e-4)) << p.transpose();
  }
}

TEST(OccupiedCells, BeginAtSixtyFivePercent) {
  OccupancyGrid map({.width = 4, .height = 1});
  map.values() = {kUnknown, 64, 65, kOccupied};
  EXPECT_EQ(occupied_cells(map).values(), (std::vector<std::uint8_t>{0, 0, 1, 1}));
}

}  // namespace
}  // namespace patrol::score::distance_field_test
