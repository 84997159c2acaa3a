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

}  // namespace
}  // namespace patrol::plan
