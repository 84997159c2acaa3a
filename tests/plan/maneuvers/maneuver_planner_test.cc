#include "plan/maneuvers/maneuver_planner.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include <gtest/gtest.h>

#include "tests/plan/kinematic_drive.h"

namespace patrol::plan::maneuver_planner_test {
namespace {

constexpr double kRouteMargin_m = 0.05;

/// An empty area, with a keep-out line along the x axis.
Costmap make_costmap_with_line() {
  CostmapSettings settings;
  settings.route_margin_m = kRouteMargin_m;
  Costmap costmap(settings, Footprint(make_cart().footprint_m, 2), {{{-15.0, 0.0}, {15.0, 0.0}}});
  costmap.include({0.0, 0.0}, 15.0);
  return costmap;
}

/// Pose beside the line, parallel to it, with a clearance.
Pose2 beside_line(const Costmap& costmap, double x_m, double clearance_m) {
  const double to_line_m = costmap.clearance_m({x_m, 1.0, 0.0});
  return {x_m, 1.0 - to_line_m + clearance_m, 0.0};
}

ManeuverResult plan(const Costmap& costmap, const Pose2& T_map_body, const Pose2& T_map_goal) {
  const NavigationGoal goal{.T_map_body = T_map_goal, .position_tolerance_m = 0.1, .yaw_tolerance_rad = 0.1};
  return ManeuverPlanner({}, make_cart()).plan(costmap, T_map_body, false, goal);
}

/// Minimum clearance of the poses of a maneuver at most, or at least, 2 m from the goal.
double min_clearance_m(const Costmap& costmap, const ManeuverResult& result, bool is_near_goal) {
  const Eigen::Vector2d p_goal = result.maneuver.back().T_map_center.position();
  double min_m = std::numeric_limits<double>::infinity();
  for (const ManeuverPose& pose : result.maneuver) {
    const bool is_near = (pose.T_map_center.position() - p_goal).norm() < 2.0;
    if (is_near == is_near_goal) min_m = std::min(min_m, costmap.clearance_m(pose.T_map_center));
  }
  return min_m;
}

TEST(ManeuverPlanner, AGoalInCollisionIsBlockedWithoutASearch) {
  const Costmap costmap = make_costmap_with_line();
  const ManeuverResult result = plan(costmap, {-8.0, 5.0, 0.0}, beside_line(costmap, 8.0, -0.01));
  EXPECT_EQ(result.status, PlanStatus::kGoalBlocked);
  EXPECT_EQ(result.num_expanded, 0);
  EXPECT_EQ(result.num_cells, 0);
}

TEST(ManeuverPlanner, NearAGoalWithinTheRouteMarginTheClearanceOfTheGoalSuffices) {
  const Costmap costmap = make_costmap_with_line();
  for (const double clearance_m : {0.02, kRouteMargin_m - 0.01}) {
    const ManeuverResult result = plan(costmap, {-8.0, 5.0, 0.0}, beside_line(costmap, 8.0, clearance_m));
    ASSERT_EQ(result.status, PlanStatus::kFound) << clearance_m;
    EXPECT_NEAR(min_clearance_m(costmap, result, true), clearance_m, 0.01);
    EXPECT_GE(min_clearance_m(costmap, result, true), 0.0);
    EXPECT_GT(min_clearance_m(costmap, result, false), kRouteMargin_m);
  }
}

TEST(ManeuverPlanner, NearAStartWithinTheRouteMarginTheClearanceOfTheStartSuffices) {
  const Costmap costmap = make_costmap_with_line();
  const Pose2 facing{-8.0, 1.0 - costmap.clearance_m({-8.0, 1.0, -M_PI / 2.0}) - 0.02, -M_PI / 2.0};
  for (const Pose2& start : {facing, beside_line(costmap, -8.0, 0.03)}) {
    const ManeuverResult result = plan(costmap, start, {8.0, 5.0, 0.0});
    ASSERT_EQ(result.status, PlanStatus::kFound) << start.vector().transpose();
    EXPECT_GE(min_clearance_m(costmap, result, false), costmap.clearance_m(start) - 0.01);
  }
}

// For example in the trace of a pedestrian, which the map has since its last update.
TEST(ManeuverPlanner, AStartInCollisionInLethalCellsIsLeft) {
  CostmapSettings settings;
  settings.keep_out_margin_m = 0.4;
  Costmap costmap(settings, Footprint(make_cart().footprint_m, 2), {{{-0.15, -0.01}, {-0.15, 0.01}}});
  costmap.include({0.0, 0.0}, 15.0);
  ASSERT_EQ(costmap.cost_at({0.0, 0.0}), kLethalCost);
  ASSERT_LT(costmap.clearance_m({}), -0.2);
  EXPECT_EQ(plan(costmap, {}, {8.0, 0.0, 0.0}).status, PlanStatus::kFound);
}

}  // namespace
}  // namespace patrol::plan::maneuver_planner_test
