#include "plan/maneuvers/dubins.h"

#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

#include "core/random.h"

namespace patrol::plan {
namespace {

Pose2 end_of(const std::vector<Arc>& arcs) {
  Pose2 pose;
  for (const Arc& arc : arcs) pose = along_arc(pose, arc.curvature_per_m, arc.length_m);
  return pose;
}

TEST(Dubins, TenThousandRandomPathsEndAtTheirGoalWithinAMicrometer) {
  const RandomStream random(1, "dubins");
  for (std::uint64_t i = 0; i < 10000; ++i) {
    const double reach = i % 2 == 0 ? 20.0 : 3.0;
    const Pose2 goal{reach * (random.uniform(i, 0) - 0.5), reach * (random.uniform(i, 1) - 0.5),
                     2.0 * std::numbers::pi * (random.uniform(i, 2) - 0.5)};
    const double radius = 0.5 + random.uniform(i, 3);
    const std::vector<Arc> arcs = dubins_path(goal, radius);
    const Pose2 end = end_of(arcs);
    ASSERT_NEAR(end.x, goal.x, 1e-6) << i;
    ASSERT_NEAR(end.y, goal.y, 1e-6) << i;
    ASSERT_NEAR(wrap_angle(end.yaw - goal.yaw), 0.0, 1e-6) << i;
    ASSERT_GE(length_m(arcs), goal.position().norm() - 1e-9);
    for (const Arc& arc : arcs) ASSERT_GE(arc.length_m, 0.0);
  }
}

TEST(Dubins, KnownPathsHaveTheirClosedFormLength) {
  const double pi = std::numbers::pi;
  EXPECT_NEAR(length_m(dubins_path({5.0, 0.0, 0.0}, 1.0)), 5.0, 1e-9);
  EXPECT_NEAR(length_m(dubins_path({0.0, 2.0, pi}, 1.0)), pi, 1e-9);  // half a circle
  EXPECT_NEAR(length_m(dubins_path({10.0, 10.0, pi / 2.0}, 2.0)), 8.0 * std::sqrt(2.0) + pi, 1e-9);
  EXPECT_NEAR(length_m(dubins_path({0.0, 0.0, pi}, 1.0)), 7.0 * pi / 3.0, 1e-9);  // to turn around: three turns
}

/// Length of the path between a random frame and a pose relative to it, with the rounding errors of the map frame.
double length_from_random_frame(std::uint64_t i, const Pose2& T_from_to, double radius_m) {
  const RandomStream random(2, "dubins");
  const Pose2 T_map_from{200.0 * (random.uniform(i, 0) - 0.5), 200.0 * (random.uniform(i, 1) - 0.5),
                         2.0 * std::numbers::pi * (random.uniform(i, 2) - 0.5)};
  return length_m(dubins_path(T_map_from.inverse() * (T_map_from * T_from_to), radius_m));
}

TEST(Dubins, AGoalStraightAheadIsReachedWithoutACircle) {
  const RandomStream random(3, "dubins");
  for (std::uint64_t i = 0; i < 10000; ++i) {
    const double distance_m = 0.01 + 20.0 * random.uniform(i, 0), radius_m = 0.5 + random.uniform(i, 1);
    ASSERT_NEAR(length_from_random_frame(i, {distance_m, 0.0, 0.0}, radius_m), distance_m, 1e-6) << i;
  }
}

TEST(Dubins, AGoalOnTheCircleOfTheMinimumRadiusIsReachedByItsArc) {
  const RandomStream random(4, "dubins");
  for (std::uint64_t i = 0; i < 10000; ++i) {
    const double radius_m = 0.5 + random.uniform(i, 0);
    const double angle_rad = (i % 2 == 0 ? 1.0 : -1.0) * (0.01 + 0.98 * std::numbers::pi * random.uniform(i, 1));
    const Pose2 goal = along_arc({}, std::copysign(1.0 / radius_m, angle_rad), radius_m * std::abs(angle_rad));
    ASSERT_NEAR(length_from_random_frame(i, goal, radius_m), radius_m * std::abs(angle_rad), 1e-6) << i;
  }
}

}  // namespace
}  // namespace patrol::plan
