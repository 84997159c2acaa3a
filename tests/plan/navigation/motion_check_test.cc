#include "plan/navigation/motion_check.h"

#include <gtest/gtest.h>

#include "tests/plan/perception/costmap_parts.h"

namespace patrol::plan::motion_check_test {
namespace {

/// Costmap of a robot 0.1 m long and wide, with one post.
Costmap costmap_with_post(const Eigen::Vector2d& p_map) {
  OccupancyGrid map = costmap_test::make_free_map();
  costmap_test::occupy(map, p_map);
  Costmap costmap({}, Footprint({{-0.05, -0.05}, {0.05, -0.05}, {0.05, 0.05}, {-0.05, 0.05}}), {});
  costmap.set_map(map);
  return costmap;
}

bool is_safe(const Costmap& costmap, double yaw_rate_radps) {
  return is_motion_safe(costmap, {}, {.vx_mps = 1.0, .yaw_rate_radps = yaw_rate_radps}, 1.0);
}

// At 1 m/s and 1 rad/s the robot is at (0.68, 0.27) after 0.75 s. The post is 0.25 m beside the straight line.
TEST(MotionCheck, APostInsideTheCurveIsHitOnTheArcButNotOnTheStraightLine) {
  for (const double side : {1.0, -1.0}) {
    const Costmap costmap = costmap_with_post({0.65, 0.25 * side});
    EXPECT_FALSE(is_safe(costmap, side)) << side;
    EXPECT_TRUE(is_safe(costmap, 0.0)) << side;
    EXPECT_TRUE(is_safe(costmap, -side)) << side;
  }
}

// The arc leaves the straight line by 0.46 m in one second.
TEST(MotionCheck, APostOnTheStraightLineIsPassedOnTheArc) {
  const Costmap costmap = costmap_with_post({0.95, 0.05});
  EXPECT_FALSE(is_safe(costmap, 0.0));
  EXPECT_TRUE(is_safe(costmap, 1.0));
  EXPECT_TRUE(is_safe(costmap, -1.0));
}

// The side of the robot passes a keep-out line at a distance of 1.5 cm beyond the margin.
TEST(MotionCheck, TheMinimumClearanceIsThatOfTheCaller) {
  CostmapSettings settings;
  const Footprint footprint({{-0.05, -0.05}, {0.05, -0.05}, {0.05, 0.05}, {-0.05, 0.05}});
  const double y_m = settings.keep_out_margin_m + 0.015;
  const Costmap costmap(settings, footprint, {{{0.4, y_m}, {2.0, y_m}}});
  EXPECT_FALSE(is_motion_safe(costmap, {}, {.vx_mps = 1.0}, 1.0));
  EXPECT_TRUE(is_motion_safe(costmap, {}, {.vx_mps = 1.0}, 1.0, 0.01));
}

}  // namespace
}  // namespace patrol::plan::motion_check_test
