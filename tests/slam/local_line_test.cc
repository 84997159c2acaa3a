#include "slam/local_line.h"

#include <cmath>

#include <gtest/gtest.h>

#include "core/geometry/angles.h"
#include "core/random.h"

namespace patrol::slam::local_line_test {
namespace {

/// Hits every centimeter along a line through `through` at `angle`, 1 m each way, scattered across by
/// `std_m`.
GridMap make_wall(const Eigen::Vector2d& through, double angle_rad, double std_m = 0.0) {
  GridMap map(0.05, 100.0);
  const RandomStream noise(1, "test/wall");
  const Eigen::Vector2d along(std::cos(angle_rad), std::sin(angle_rad)), across(-along.y(), along.x());
  for (int i = -100; i <= 100; ++i) {
    for (std::uint64_t repeat = 0; repeat < 20; ++repeat) {
      const double scatter = std_m * noise.normal(static_cast<std::uint64_t>(i + 100), repeat);
      map.add_hit(through + 0.01 * i * along + scatter * across);
    }
  }
  return map;
}

TEST(FitLocalLine, MeasuresThreeCentimetersFromAWallAtAnyAngleToATenthOfAMillimeter) {
  for (int degrees = 0; degrees < 180; degrees += 7) {
    const double angle = to_rad(degrees);
    const GridMap map = make_wall({0.312, -0.457}, angle);
    const Eigen::Vector2d across(-std::sin(angle), std::cos(angle));
    const auto line = fit_local_line(map, Eigen::Vector2d(0.312, -0.457) + 0.03 * across, 3);
    ASSERT_TRUE(line) << degrees;
    EXPECT_NEAR(std::abs(line->distance_m(Eigen::Vector2d(0.312, -0.457) + 0.03 * across)), 0.03, 1e-4) << degrees;
    EXPECT_NEAR(std::abs(line->normal_map.dot(across)), 1.0, 1e-3) << degrees;
    EXPECT_GT(line->linearity, 0.99) << degrees;
    EXPECT_LT(line->normal_var_m2, 1e-6) << degrees;
  }
}

TEST(FitLocalLine, LiesInTheMiddleOfNoisyHitsOverTwoCellsToTwoMillimeters) {
  // The wall stands on the border of two cells: half of the hits fall in either.
  const GridMap map = make_wall({0.0, 0.5}, 0.0, 0.01);
  const auto line = fit_local_line(map, {0.0, 0.52}, 3);
  ASSERT_TRUE(line);
  EXPECT_NEAR(std::abs(line->distance_m({0.0, 0.52})), 0.02, 0.002);
}

TEST(FitLocalLine, ACornerIsNotStraight) {
  GridMap map = make_wall({0.02, 0.02}, 0.0);
  for (int i = -100; i <= 100; ++i) map.add_hit({0.02, 0.02 + 0.01 * i});
  const auto line = fit_local_line(map, {0.02, 0.02}, 3);
  ASSERT_TRUE(line);
  EXPECT_LT(line->linearity, 0.97);
}

TEST(FitLocalLine, TwoCellsOrNoneMakeNoLine) {
  GridMap map(0.05, 100.0);
  EXPECT_FALSE(fit_local_line(map, {0.0, 0.0}, 3));
  map.add_hit({0.01, 0.01});
  map.add_hit({0.06, 0.01});
  EXPECT_FALSE(fit_local_line(map, {0.0, 0.0}, 3));
  map.add_hit({0.11, 0.01});
  EXPECT_TRUE(fit_local_line(map, {0.0, 0.0}, 3));
}

}  // namespace
}  // namespace patrol::slam::local_line_test
