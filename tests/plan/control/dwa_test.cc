#include "plan/control/dwa.h"

#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

#include "tests/support/pose_near.h"

namespace patrol::plan::dwa_test {
namespace {

using std::numbers::pi;
using test::Pose2Near;

constexpr double kExactTol = 1e-9;
constexpr double kControlPeriod_s = 0.1;

// A quarter of a circle of radius v / w = 1 m.
TEST(FollowArc, AQuarterCircleEndsOneMetreAheadAndOneToTheLeft) {
  EXPECT_THAT(follow_arc({}, 1.0, 1.0, pi / 2.0), Pose2Near(Pose2{1.0, 1.0, pi / 2.0}, kExactTol, kExactTol));
}

TEST(FollowArc, AWholeCircleComesBack) {
  const Pose2 start{3.0, -1.0, 0.4};
  EXPECT_THAT(follow_arc(start, 0.8, -0.5, 2.0 * pi / 0.5), Pose2Near(start, kExactTol, kExactTol));
}

TEST(FollowArc, BackwardsIsTheWayBack) {
  const Pose2 start{3.0, -1.0, 0.4};
  const Pose2 there = follow_arc(start, 0.7, 0.3, 1.7);
  EXPECT_THAT(follow_arc(there, -0.7, -0.3, 1.7), Pose2Near(start, kExactTol, kExactTol));
}

TEST(FollowArc, WithoutTurningIsStraightAndWithoutSpeedTurnsInPlace) {
  EXPECT_THAT(follow_arc({1.0, 2.0, pi / 2.0}, 0.5, 0.0, 4.0),
              Pose2Near(Pose2{1.0, 4.0, pi / 2.0}, kExactTol, kExactTol));
  EXPECT_THAT(follow_arc({1.0, 2.0, 3.0}, 0.0, 0.5, 1.0), Pose2Near(Pose2{1.0, 2.0, 3.5}, kExactTol, kExactTol));
}

TEST(FollowArc, IsSmoothWhereTheTurnVanishes) {
  const Pose2 a = follow_arc({}, 1.0, 0.99e-6, 1.0), b = follow_arc({}, 1.0, 1.01e-6, 1.0);
  EXPECT_THAT(a, Pose2Near(b, 1e-7, 1e-7));
}

TEST(FollowArc, EqualsManySmallSteps) {
  Pose2 stepped{0.3, 0.1, -2.0};
  constexpr int kSteps = 20000;
  for (int i = 0; i < kSteps; ++i) {  // midpoint rule: error of order dt^2
    const double dt = 1.5 / kSteps;
    stepped = stepped * Pose2{0.6 * dt * std::cos(0.45 * dt), 0.6 * dt * std::sin(0.45 * dt), 0.9 * dt};
  }
  EXPECT_THAT(follow_arc({0.3, 0.1, -2.0}, 0.6, 0.9, 1.5), Pose2Near(stepped, 1e-8, 1e-8));
}

TEST(FollowArc, ALateralMotionWithATurnEqualsManySmallSteps) {
  Pose2 stepped{0.3, 0.1, -2.0};
  constexpr int kSteps = 20000;
  for (int i = 0; i < kSteps; ++i) {
    const double dt = 1.5 / kSteps, c = std::cos(0.45 * dt), s = std::sin(0.45 * dt);
    stepped = stepped * Pose2{dt * (0.6 * c + 0.4 * s), dt * (0.6 * s - 0.4 * c), 0.9 * dt};
  }
  EXPECT_THAT(follow_arc({0.3, 0.1, -2.0}, 0.6, 0.9, 1.5, -0.4), Pose2Near(stepped, 1e-8, 1e-8));
  EXPECT_THAT(follow_arc({}, 0.0, 0.0, 2.0, 0.3), Pose2Near(Pose2{0.0, 0.6, 0.0}, kExactTol, kExactTol));
}

/// 12 m by 12 m of free ground about the origin, with the walls that a test adds.
class Ground {
 public:
  Ground() : map_({.resolution_m = 0.1, .width = 120, .height = 120, .origin_m = {-6.0, -6.0}}, kFree) {}
  /// Its surface runs along the rectangle's edges.
  Ground& add_block(double x_min, double y_min, double x_max, double y_max) {
    for (double x = x_min + 0.05; x < x_max; x += 0.1) {
      for (double y = y_min + 0.05; y < y_max; y += 0.1) map_.at(map_.geometry().cell_at({x, y})) = kOccupied;
    }
    return *this;
  }
  Costmap costmap() const {
    Costmap costmap({}, Footprint({{-0.35, -0.15}, {0.35, -0.15}, {0.35, 0.15}, {-0.35, 0.15}}), {});
    costmap.set_map(map_);
    return costmap;
  }

 private:
  OccupancyGrid map_;
};

PlannedPath make_path(const std::vector<Eigen::Vector2d>& points) { return PlannedPath(points); }

Twist3 moving(double vx_mps, double yaw_rate_radps = 0.0) {
  return {.linear = {vx_mps, 0.0, 0.0}, .angular = {0.0, 0.0, yaw_rate_radps}};
}

/// Drives for a time as the dynamic window says; stands where it says nothing.
Pose2 drive(const DynamicWindow& window, const Costmap& costmap, const PlannedPath& path, Pose2 T_map_body,
            double time_s, double* min_clearance_m = nullptr) {
  VelocityCommand command;
  double along_m = 0.0;
  for (double t = 0.0; t < time_s; t += kControlPeriod_s) {
    along_m = path.project(T_map_body.position(), along_m, along_m + 1.0).along_m;
    command = window.choose(costmap, path, along_m, T_map_body, moving(command.vx_mps, command.yaw_rate_radps), 10.0)
                  .value_or(VelocityCommand{});
    T_map_body = follow_arc(T_map_body, command.vx_mps, command.yaw_rate_radps, kControlPeriod_s);
    if (min_clearance_m != nullptr) *min_clearance_m = std::min(*min_clearance_m, costmap.clearance_m(T_map_body));
  }
  return T_map_body;
}

TEST(RollOut, UntilContactEndsWithTheFirstPoseWithoutClearanceAndIsOtherwiseEqual) {
  const Costmap costmap({}, Footprint({{-0.3, -0.2}, {0.3, -0.2}, {0.3, 0.2}, {-0.3, 0.2}}),
                        {{{1.0, -2.0}, {1.0, 2.0}}});  // a keep-out line across, 1 m ahead
  const Rollout whole = roll_out(costmap, {}, 1.0, 0.1, 2.0, 10),
                ended = roll_out(costmap, {}, 1.0, 0.1, 2.0, 10, 0.0, true),
                aside = roll_out(costmap, {}, -0.5, 0.1, 2.0, 10, 0.0, true);
  EXPECT_EQ(whole.T_map_body.size(), 10U);
  EXPECT_EQ(aside.T_map_body.size(), 10U) << "it never touches the line";
  ASSERT_GE(ended.T_map_body.size(), 2U);
  ASSERT_LE(ended.T_map_body.size(), 6U);
  EXPECT_LE(ended.min_clearance_m, 0.0);
  EXPECT_LE(whole.min_clearance_m, ended.min_clearance_m);
  EXPECT_GT(costmap.clearance_m(whole.T_map_body[ended.T_map_body.size() - 2]), 0.0);
  for (std::size_t i = 0; i < ended.T_map_body.size(); ++i)
    EXPECT_THAT(ended.T_map_body[i], Pose2Near(whole.T_map_body[i], 0.0, 0.0));
}

TEST(DynamicWindow, OnAStraightFreePathDrivesStraightAtFullSpeed) {
  const Costmap costmap = Ground().costmap();
  const DwaSettings settings;
  const auto command = DynamicWindow(settings).choose(costmap, make_path({{-4.0, 0.0}, {5.0, 0.0}}), 2.0,
                                                      {-2.0, 0.0, 0.0}, moving(settings.max_speed_mps), 10.0);
  ASSERT_TRUE(command);
  EXPECT_NEAR(command->vx_mps, settings.max_speed_mps, kExactTol);
  EXPECT_NEAR(command->yaw_rate_radps, 0.0, kExactTol);
  EXPECT_EQ(command->vy_mps, 0.0);
}

// From rest within window_s = 0.3 s at 0.8 m/s^2 and 2.5 rad/s^2.
TEST(DynamicWindow, AsksOnlyForWhatIsInReach) {
  const Costmap costmap = Ground().costmap();
  const DwaSettings settings{.max_acceleration_mps2 = 0.8, .max_yaw_acceleration_radps2 = 2.0, .window_s = 0.3};
  const DynamicWindow window(settings);
  const auto ahead = window.choose(costmap, make_path({{0.0, 0.0}, {5.0, 0.0}}), 0.0, {}, {}, 10.0);
  ASSERT_TRUE(ahead);
  EXPECT_NEAR(ahead->vx_mps, 0.8 * 0.3, kExactTol);
  const auto aside = window.choose(costmap, make_path({{0.0, 0.0}, {0.0, 5.0}}), 0.0, {}, {}, 10.0);
  ASSERT_TRUE(aside);
  EXPECT_NEAR(aside->yaw_rate_radps, 2.0 * 0.3, kExactTol);
}

TEST(DynamicWindow, KeepsTheSpeedLimitOrBrakesTowardsIt) {
  const Costmap costmap = Ground().costmap();
  const DynamicWindow window({.max_acceleration_mps2 = 0.8, .window_s = 0.3});
  const PlannedPath path = make_path({{0.0, 0.0}, {5.0, 0.0}});
  EXPECT_NEAR(window.choose(costmap, path, 0.0, {}, moving(0.3), 0.35)->vx_mps, 0.35, kExactTol);
  EXPECT_LE(window.choose(costmap, path, 0.0, {}, moving(0.8), 0.1)->vx_mps, 0.8 - 0.24 + kExactTol);
}

TEST(DynamicWindow, TurnsTowardsAPathThatBendsEitherWay) {
  const Costmap costmap = Ground().costmap();
  const DynamicWindow window({});
  const auto left = window.choose(costmap, make_path({{0.0, 0.0}, {0.3, 0.0}, {0.3, 5.0}}), 0.0, {}, moving(0.4), 10.0);
  const auto right =
      window.choose(costmap, make_path({{0.0, 0.0}, {0.3, 0.0}, {0.3, -5.0}}), 0.0, {}, moving(0.4), 10.0);
  ASSERT_TRUE(left && right);
  EXPECT_GT(left->yaw_rate_radps, 0.2);
  EXPECT_NEAR(right->yaw_rate_radps, -left->yaw_rate_radps, kExactTol);  // mirrored
}

TEST(DynamicWindow, ReturnsToAPathHalfAMetreAside) {
  const Costmap costmap = Ground().costmap();
  const Pose2 end = drive(DynamicWindow({}), costmap, make_path({{-5.0, 0.0}, {5.5, 0.0}}), {-4.0, 0.5, 0.0}, 10.0);
  EXPECT_NEAR(end.y, 0.0, 0.08);
  EXPECT_GT(end.x, 1.0);
}

TEST(DynamicWindow, WithALateralSpeedOf0_3ReturnsToAPathHalfAMeterAsideInLessThanThreeQuartersOfTheTime) {
  const Costmap costmap = Ground().costmap();
  const PlannedPath path = make_path({{-5.0, 0.0}, {5.5, 0.0}});
  const auto return_time_s = [&](const DwaSettings& settings) {
    const DynamicWindow window(settings);
    Pose2 pose{-4.0, 0.5, 0.0};
    VelocityCommand command;
    double time_s = 0.0;
    for (double t = 0.0; t < 10.0; t += kControlPeriod_s) {
      Twist3 twist = moving(command.vx_mps, command.yaw_rate_radps);
      twist.linear.y() = command.vy_mps;
      command =
          window.choose(costmap, path, path.project(pose.position(), 0.0, 10.0).along_m, pose, twist, 10.0).value();
      EXPECT_LE(std::abs(command.vy_mps), settings.max_lateral_speed_mps + kExactTol);
      pose = follow_arc(pose, command.vx_mps, command.yaw_rate_radps, kControlPeriod_s, command.vy_mps);
      if (std::abs(pose.y) > 0.08) time_s = t;
    }
    EXPECT_NEAR(pose.y, 0.0, 0.08);
    EXPECT_GT(pose.x, 1.0);
    return time_s;
  };
  EXPECT_LT(return_time_s({.max_lateral_speed_mps = 0.3}), 0.75 * return_time_s({}));
}

// The path leads into a wall with its surface at x = 2: the nose is 0.35 m before the body.
TEST(DynamicWindow, StopsBeforeAWallAcrossThePath) {
  const Costmap costmap = Ground().add_block(2.0, -6.0, 2.3, 6.0).costmap();
  double min_clearance_m = 1.0;
  const Pose2 end =
      drive(DynamicWindow({}), costmap, make_path({{-5.0, 0.0}, {5.0, 0.0}}), {-1.0, 0.0, 0.0}, 12.0, &min_clearance_m);
  EXPECT_LT(end.x + 0.35, 2.0);
  EXPECT_GT(min_clearance_m, -0.01);
}

TEST(DynamicWindow, FollowsAPathAroundABlockWithoutTouchingIt) {
  const Costmap costmap = Ground().add_block(-0.5, -0.5, 0.5, 0.5).costmap();
  const PlannedPath path = make_path({{-4.0, 0.0}, {-1.5, 0.0}, {-0.8, 1.0}, {0.8, 1.0}, {1.5, 0.0}, {5.0, 0.0}});
  double min_clearance_m = 1.0;
  const Pose2 end = drive(DynamicWindow({}), costmap, path, {-3.5, 0.0, 0.0}, 15.0, &min_clearance_m);
  EXPECT_GT(end.x, 2.0);
  EXPECT_GT(min_clearance_m, 0.0);
}

// Along a wall and past a block that leaves 0.75 m for a robot 0.3 m wide: nothing there is comfortable, but
// standing gets nowhere.
TEST(DynamicWindow, AtRestBeforeANarrowPlaceMovesOn) {
  const Costmap costmap = Ground().add_block(-6.0, 0.4, 6.0, 0.6).add_block(1.0, -1.4, 1.5, -0.4).costmap();
  const PlannedPath path = make_path({{-0.3, -0.6}, {0.95, -0.05}, {1.65, -0.05}, {3.0, -0.6}});
  for (const double x : {0.0, 0.1, 0.2, 0.3, 0.4}) {
    const Pose2 start{x, -0.55 + 0.4 * (x + 0.3), 0.3};
    const auto command =
        DynamicWindow({}).choose(costmap, path, path.project(start.position(), 0.0, 2.0).along_m, start, {}, 10.0);
    ASSERT_TRUE(command) << x;
    EXPECT_GT(command->vx_mps, 0.1) << x;
  }
}

TEST(DynamicWindow, InABoxWithNoRoomSaysSo) {
  // Obstacles all around at a hand's breadth: no arc is free, and none leads away.
  const Costmap costmap = Ground()
                              .add_block(-0.6, -0.6, 0.6, -0.2)
                              .add_block(-0.6, 0.2, 0.6, 0.6)
                              .add_block(0.4, -0.3, 0.8, 0.3)
                              .add_block(-0.8, -0.3, -0.4, 0.3)
                              .costmap();
  EXPECT_FALSE(DynamicWindow({}).choose(costmap, make_path({{0.0, 0.0}, {5.0, 0.0}}), 0.0, {}, {}, 10.0));
}

// The block's surface lies 0.17 m to the left, the outline's 0.15 m: nearer than the margin of 0.05 m. The
// path leads off to the right.
TEST(DynamicWindow, TooNearToSomethingLeadsAwayFromIt) {
  const Costmap costmap = Ground().add_block(-0.6, 0.2, 0.2, 0.6).costmap();
  const Pose2 start{0.2, 0.03, 0.0};
  ASSERT_LT(costmap.clearance_m(start), 0.0);
  const PlannedPath path = make_path({{0.2, 0.03}, {2.0, -1.0}, {4.0, -1.0}});
  const auto command = DynamicWindow({}).choose(costmap, path, 0.0, start, {}, 10.0);
  ASSERT_TRUE(command);
  const Pose2 next = follow_arc(start, command->vx_mps, command->yaw_rate_radps, 2.0);
  EXPECT_GT(costmap.clearance_m(next), costmap.clearance_m(start));
}

}  // namespace
}  // namespace patrol::plan::dwa_test
