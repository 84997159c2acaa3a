#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

#include "plan/control/rollouts/clearance.h"
#include "plan/control/rollouts/command_change.h"
#include "plan/control/rollouts/path_distance.h"
#include "plan/control/rollouts/path_heading.h"
#include "plan/control/rollouts/progress.h"

namespace patrol::plan::rollout_costs_test {
namespace {

using std::numbers::pi;

constexpr double kExactTol = 1e-9;

/// 10 m along x.
PlannedPath make_path() { return PlannedPath({{0.0, 0.0}, {10.0, 0.0}}); }

/// A robot 2 m along the path that can get 1 m far.
RolloutScene make_scene(const PlannedPath& path) {
  return {.path = path,
          .along_m = 2.0,
          .reachable_distance_m = 1.0,
          .twist = {.linear = {0.4, 0.0, 0.0}, .angular = {0.0, 0.0, 0.2}},
          .max_speed_mps = 0.8,
          .max_yaw_rate_radps = 1.0};
}

/// A straight rollout of four poses from `from` to `to`.
Rollout make_rollout(const Pose2& from, const Pose2& to) {
  Rollout rollout;
  for (int i = 1; i <= 4; ++i) {
    const double part = i / 4.0;
    rollout.T_map_body.push_back({from.x + part * (to.x - from.x), from.y + part * (to.y - from.y), to.yaw});
  }
  return rollout;
}

TEST(ClearanceCost, IsOneAtContactAQuarterHalfWayAndNothingWhereItIsComfortable) {
  const PlannedPath path = make_path();
  const RolloutScene scene = make_scene(path);
  const ClearanceCost cost{.comfortable_m = 0.4};
  const auto at = [&](double clearance_m) {
    Rollout rollout;
    rollout.min_clearance_m = clearance_m;
    return cost(rollout, scene);
  };
  EXPECT_NEAR(at(0.0), 1.0, kExactTol);
  EXPECT_NEAR(at(-0.1), 1.0, kExactTol);
  EXPECT_NEAR(at(0.2), 0.25, kExactTol);
  EXPECT_NEAR(at(0.4), 0.0, kExactTol);
  EXPECT_NEAR(at(5.0), 0.0, kExactTol);
}

// From 0.4 to 0.6 m/s of 0.8, from 0.2 to -0.3 rad/s of 1.
TEST(CommandChangeCost, AddsTheSharesOfBothLimits) {
  const PlannedPath path = make_path();
  Rollout rollout;
  rollout.vx_mps = 0.6;
  rollout.yaw_rate_radps = -0.3;
  EXPECT_NEAR(CommandChangeCost{}(rollout, make_scene(path)), 0.2 / 0.8 + 0.5 / 1.0, kExactTol);
}

// Poses at y = 0.1, 0.2, 0.3, 0.4: the one at half time and the last count, (0.2 + 0.4) / 2 of 0.5 m.
TEST(PathDistanceCost, IsTheMeanDistanceOfMiddleAndEnd) {
  const PlannedPath path = make_path();
  const PathDistanceCost cost{.full_m = 0.5};
  EXPECT_NEAR(cost(make_rollout({2.0, 0.0, 0.0}, {3.0, 0.4, 0.0}), make_scene(path)), 0.3 / 0.5, kExactTol);
  EXPECT_NEAR(cost(make_rollout({2.0, 0.0, 0.0}, {3.0, 0.0, 0.0}), make_scene(path)), 0.0, kExactTol);
  EXPECT_NEAR(cost(make_rollout({2.0, 3.0, 0.0}, {3.0, 3.0, 0.0}), make_scene(path)), 1.0, kExactTol);
}

TEST(PathHeadingCost, IsTheAngleToAPointAheadAsAShareOfAHalfTurn) {
  const PlannedPath path = make_path();
  const PathHeadingCost cost{.look_ahead_m = 0.6};
  const auto looking = [&](double y, double yaw) {
    return cost(make_rollout({2.0, y, yaw}, {2.5, y, yaw}), make_scene(path));
  };
  EXPECT_NEAR(looking(0.0, 0.0), 0.0, kExactTol);
  EXPECT_NEAR(looking(0.0, pi / 2.0), 0.5, kExactTol);
  EXPECT_NEAR(looking(0.0, -pi / 2.0), 0.5, kExactTol);
  EXPECT_NEAR(looking(0.0, pi), 1.0, kExactTol);
  EXPECT_NEAR(looking(0.6, -pi / 4.0), 0.0, kExactTol);  // 0.6 m aside: the point ahead lies at 45 degrees
}

TEST(ProgressCost, IsWhatIsMissingOfTheWayInReach) {
  const PlannedPath path = make_path();
  const auto to = [&](double x) {
    return ProgressCost{}(make_rollout({2.0, 0.0, 0.0}, {x, 0.0, 0.0}), make_scene(path));
  };
  EXPECT_NEAR(to(3.0), 0.0, kExactTol);  // all of 1 m
  EXPECT_NEAR(to(2.25), 0.75, kExactTol);
  EXPECT_NEAR(to(2.0), 1.0, kExactTol);   // stands
  EXPECT_NEAR(to(1.5), 1.5, kExactTol);   // back
  EXPECT_NEAR(to(-5.0), 2.0, kExactTol);  // no worse than all of it backwards
}

TEST(ProgressCost, NearTheEndOnlyWhatIsLeftCounts) {
  const PlannedPath path = make_path();
  RolloutScene scene = make_scene(path);
  scene.along_m = 9.6;
  EXPECT_NEAR(ProgressCost{}(make_rollout({9.6, 0.0, 0.0}, {9.8, 0.0, 0.0}), scene), 0.5, kExactTol);
  scene.along_m = 10.0;
  EXPECT_NEAR(ProgressCost{}(make_rollout({10.0, 0.0, 0.0}, {10.0, 0.0, 0.0}), scene), 0.0, kExactTol);
}

}  // namespace
}  // namespace patrol::plan::rollout_costs_test
