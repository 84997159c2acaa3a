#include "plan/navigation/maneuver_follower.h"

#include <gtest/gtest.h>

#include "plan/control/rollouts/rollout.h"
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

}  // namespace
}  // namespace patrol::plan::maneuver_follower_test
