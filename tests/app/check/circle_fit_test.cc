#include "app/check/circle_fit.h"

#include <cmath>

#include <gtest/gtest.h>

namespace patrol::app::circle_fit_test {
namespace {

std::vector<Eigen::Vector2d> arc(const Eigen::Vector2d& center_m, double radius_m, double from_rad, double to_rad,
                                 double ripple_m = 0.0) {
  std::vector<Eigen::Vector2d> points_m;
  constexpr int kNumPoints = 200;
  for (int i = 0; i < kNumPoints; ++i) {
    const double angle = from_rad + (to_rad - from_rad) * i / kNumPoints;
    const double r = radius_m + ripple_m * std::sin(40.0 * angle);
    points_m.emplace_back(center_m + r * Eigen::Vector2d(std::cos(angle), std::sin(angle)));
  }
  return points_m;
}

TEST(CircleFit, OfPointsOnAnArcIsTheirCircleToRounding) {
  const Circle circle = fit_circle(arc({3.0, -2.0}, 1.5, 0.3, 1.8));
  EXPECT_NEAR(circle.radius_m, 1.5, 1e-9);
  EXPECT_NEAR((circle.center_m - Eigen::Vector2d(3.0, -2.0)).norm(), 0.0, 1e-9);
}

TEST(CircleFit, OfAFullCircleWithARippleOf1CentimeterIsWithin1Millimeter) {
  const Circle circle = fit_circle(arc({0.0, 2.0}, 2.0, 0.0, 2.0 * M_PI, 0.01));
  EXPECT_NEAR(circle.radius_m, 2.0, 1e-3);
  EXPECT_NEAR((circle.center_m - Eigen::Vector2d(0.0, 2.0)).norm(), 0.0, 1e-3);
}

}  // namespace
}  // namespace patrol::app::circle_fit_test
