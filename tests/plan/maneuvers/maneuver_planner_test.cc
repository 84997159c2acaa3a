#include "plan/maneuvers/maneuver_planner.h"

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

// Every pose of a maneuver needs more clearance than the route margin, the last pose too.
TEST(ManeuverPlanner, AGoalWithinTheRouteMarginIsBlockedWithoutASearch) {
  const Costmap costmap = make_costmap_with_line();
  const Pose2 start{-8.0, 5.0, 0.0};
  const ManeuverResult within = plan(costmap, start, beside_line(costmap, 8.0, kRouteMargin_m - 0.02));
  EXPECT_EQ(within.status, PlanStatus::kGoalBlocked);
  EXPECT_EQ(within.num_expanded, 0);
  EXPECT_EQ(within.num_cells, 0);
  const ManeuverResult beyond = plan(costmap, start, beside_line(costmap, 8.0, kRouteMargin_m + 0.02));
  EXPECT_EQ(beyond.status, PlanStatus::kFound);
}

TEST(ManeuverPlanner, NearTheStartItsClearanceSufficesAtTheGoal) {
  const Costmap costmap = make_costmap_with_line();
  const Pose2 start = beside_line(costmap, 0.0, 0.02);
  EXPECT_EQ(plan(costmap, start, beside_line(costmap, 1.5, 0.02)).status, PlanStatus::kFound);
  EXPECT_EQ(plan(costmap, start, beside_line(costmap, 3.0, 0.02)).status, PlanStatus::kGoalBlocked);
}

}  // namespace
}  // namespace patrol::plan::maneuver_planner_test
