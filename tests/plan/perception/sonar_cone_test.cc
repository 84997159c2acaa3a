#include "plan/perception/sonar_cone.h"

#include <cmath>
#include <limits>
#include <numbers>

#include <gtest/gtest.h>

namespace patrol::plan::sonar_cone_test {
namespace {

constexpr double kSpacing_m = 0.1;
constexpr double kFov_rad = 0.6;

UltrasonicRange ping(float range_m) {
  return {.stamp = {},
          .transducer = 0,
          .field_of_view_rad = kFov_rad,
          .range_min_m = 0.2,
          .range_max_m = 4.0,
          .range_m = range_m};
}

/// High enough that the ground is out of the question; looking along +y from (0.5, 0.2).
Pose3 transducer() { return {{0.5, 0.2, 5.0}, quaternion_from_yaw(std::numbers::pi / 2.0)}; }

TEST(SonarCone, AnEchoLiesOnAnArcAtItsRangeWithinTheBelievedPartOfTheCone) {
  const SonarCone cone = inverse_sonar_model({.fov_fraction = 0.7}, ping(0.8F), transducer(), 0.15, kSpacing_m);
  ASSERT_GT(cone.arc_m.size(), 5u);
  for (const Eigen::Vector2d& p : cone.arc_m) {
    const Eigen::Vector2d from = p - Eigen::Vector2d(0.5, 0.2);
    EXPECT_NEAR(from.norm(), 0.8, 1e-6);
    EXPECT_LE(std::abs(std::atan2(from.x(), from.y())), 0.7 * kFov_rad / 2.0 + 1e-9);
  }
  for (std::size_t i = 1; i < cone.arc_m.size(); ++i) {
    EXPECT_LE((cone.arc_m[i] - cone.arc_m[i - 1]).norm(), kSpacing_m / 2.0 + 1e-9);
  }
}

TEST(SonarCone, GroundNearerThanTheEchoIsFreeUpToASpacingBeforeIt) {
  const SonarCone cone = inverse_sonar_model({}, ping(0.8F), transducer(), 0.15, kSpacing_m);
  double farthest_m = 0.0;
  for (const Eigen::Vector2d& p : cone.free_m)
    farthest_m = std::max(farthest_m, (p - Eigen::Vector2d(0.5, 0.2)).norm());
  EXPECT_LT(farthest_m, 0.7 + 1e-6);  // the range is a float
  EXPECT_GT(farthest_m, 0.6);
}

TEST(SonarCone, WithoutEchoOrWithOneFromFarAwayOnlyFrees) {
  for (const float range : {2.5F, std::numeric_limits<float>::infinity()}) {
    const SonarCone cone = inverse_sonar_model({.max_range_m = 1.2}, ping(range), transducer(), 0.15, kSpacing_m);
    EXPECT_TRUE(cone.arc_m.empty());
    EXPECT_FALSE(cone.free_m.empty());
  }
}

TEST(SonarCone, SomethingTooNearToMeasureIsPutAtTheLeastRange) {
  const SonarCone cone =
      inverse_sonar_model({}, ping(-std::numeric_limits<float>::infinity()), transducer(), 0.15, kSpacing_m);
  ASSERT_FALSE(cone.arc_m.empty());
  EXPECT_NEAR((cone.arc_m.front() - Eigen::Vector2d(0.5, 0.2)).norm(), 0.2, 1e-9);
}

TEST(SonarCone, AnInvalidReadingSaysNothing) {
  const SonarCone cone =
      inverse_sonar_model({}, ping(std::numeric_limits<float>::quiet_NaN()), transducer(), 0.15, kSpacing_m);
  EXPECT_TRUE(cone.arc_m.empty());
  EXPECT_TRUE(cone.free_m.empty());
}

// A level transducer 0.25 m up: the lower edge of a cone of 0.6 rad meets the ground at 0.25 / sin(0.3) = 0.846 m, and
// 0.85 of that is 0.719 m. Looking down by 0.2 rad it is 0.25 / sin(0.5) = 0.521 m, and 0.443 m.
TEST(SonarCone, AnEchoThatMayBeTheGroundMarksNothing) {
  const Pose3 level{{0.4, 0.0, 0.10}, Eigen::Quaterniond::Identity()};
  EXPECT_FALSE(inverse_sonar_model({}, ping(0.71F), level, 0.15, kSpacing_m).arc_m.empty());
  EXPECT_TRUE(inverse_sonar_model({}, ping(0.73F), level, 0.15, kSpacing_m).arc_m.empty());
  const Pose3 down{{0.4, 0.0, 0.10}, quaternion_from_rpy(0.0, 0.2, 0.0)};
  EXPECT_FALSE(inverse_sonar_model({}, ping(0.43F), down, 0.15, kSpacing_m).arc_m.empty());
  EXPECT_TRUE(inverse_sonar_model({}, ping(0.45F), down, 0.15, kSpacing_m).arc_m.empty());
}

}  // namespace
}  // namespace patrol::plan::sonar_cone_test
