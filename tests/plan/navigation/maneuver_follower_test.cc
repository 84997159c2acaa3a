#include "plan/navigation/maneuver_follower.h"

#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

#include "plan/control/rollouts/rollout.h"
#include "plan/maneuvers/dubins.h"
#include "tests/plan/perception/costmap_parts.h"

namespace patrol::plan::maneuver_follower_test {
namespace {

/// Speed that a follower commands on a left turn of 1 m radius at 1 m/s, to a robot 0.1 m long and wide whose turn
/// center is 0.5 m behind the origin, in front of a post.
double speed_before_post(const Eigen::Vector2d& p_map) {
  const Pose2 T_body_center{-0.5, 0.0, 0.0};
  PlanResult route;
  for (int i = 0; i < 30; ++i) {
    const Pose2 T_map_center = follow_arc(T_body_center, 0.1 * i, 0.1 * i, 1.0);
    route.points_m.push_back(T_map_center.position());
    route.maneuver.push_back({.T_map_center = T_map_center, .curvature_per_m = 1.0, .along_m = 0.1 * i});
  }
  OccupancyGrid map = costmap_test::make_free_map(0.05);
  costmap_test::occupy(map, p_map);
  Costmap costmap({}, Footprint({{-0.05, -0.05}, {0.05, -0.05}, {0.05, 0.05}, {-0.05, 0.05}}), {});
  costmap.set_map(map);
  NavigatorSettings settings;
  settings.local_planner.dwa.max_speed_mps = 1.0;
  settings.local_planner.dwa.max_yaw_rate_radps = 1.0;
  ManeuverFollower follower(settings, T_body_center, 1.0);
  follower.set_route(route, {});
  return follower.command(costmap, {}, {.vx_mps = 1.0, .yaw_rate_radps = 1.0}).vx_mps;
}

// After 0.8 s at 0.7 m/s the origin is at (0.45, 0.41); without its own sideways motion it would be at (0.53, 0.15).
TEST(ManeuverFollower, APostInTheWayOfAnOriginBeforeTheTurnCenterStopsIt) {
  EXPECT_GT(speed_before_post({-3.0, -3.0}), 0.5);
  EXPECT_EQ(speed_before_post({0.4, 0.42}), 0.0);
  EXPECT_GT(speed_before_post({0.6, 0.1}), 0.2);
}

/// Maximum lateral error at 0.5 m/s on an S of two arcs of 1.5 m radius, forward or backward. The steering takes 0.37 s
/// from one side to the other.
double max_error_on_s(bool is_reverse) {
  const double direction = is_reverse ? -1.0 : 1.0;
  PlanResult route;
  Pose2 pose;
  for (int i = 0; i <= 40; ++i) {
    const double curvature_per_m = i <= 20 ? 1.0 / 1.5 : -1.0 / 1.5;
    if (i > 0) pose = along_arc(pose, direction * curvature_per_m, direction * 0.1);
    route.points_m.push_back(pose.position());
    route.maneuver.push_back(
        {.T_map_center = pose, .curvature_per_m = curvature_per_m, .is_reverse = is_reverse, .along_m = 0.1 * i});
  }
  Costmap costmap({}, Footprint({{-0.05, -0.05}, {0.05, -0.05}, {0.05, 0.05}, {-0.05, 0.05}}), {});
  NavigatorSettings settings;
  settings.local_planner.dwa.max_speed_mps = 0.5;
  settings.local_planner.dwa.max_reverse_mps = 0.5;
  settings.local_planner.dwa.max_yaw_rate_radps = 1.0;
  ManeuverFollower follower(settings, {}, 1.0 / 1.3);
  follower.set_route(route, {});
  constexpr double kPeriod_s = 0.05, kMaxChange_per_m = 2.0 / 1.5 / 0.37 * kPeriod_s;
  VelocityCommand last{.vx_mps = direction * 0.5, .yaw_rate_radps = 0.5 / 1.5};
  double curvature_per_m = 1.0 / 1.5, max_m = 0.0;
  Pose2 T_map_body;
  for (int tick = 0; tick < 200 && !follower.has_ended(); ++tick) {
    last = follower.command(costmap, T_map_body, last);
    if (last.vx_mps == 0.0) break;
    const double speed_mps = std::abs(last.vx_mps);
    curvature_per_m +=
        std::clamp(last.yaw_rate_radps / speed_mps - curvature_per_m, -kMaxChange_per_m, kMaxChange_per_m);
    T_map_body = follow_arc(T_map_body, last.vx_mps, curvature_per_m * speed_mps, kPeriod_s);
    max_m = std::max(max_m, follower.advance(T_map_body));
  }
  EXPECT_TRUE(follower.has_ended()) << T_map_body.vector().transpose();
  return max_m;
}

TEST(ManeuverFollower, SteersBeforeTheCurvatureChanges) {
  EXPECT_LT(max_error_on_s(false), 0.03);
  EXPECT_LT(max_error_on_s(true), 0.03);
}

}  // namespace
}  // namespace patrol::plan::maneuver_follower_test
