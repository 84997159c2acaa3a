#pragma once

#include "core/frames.h"
#include "core/navigation_goal.h"
#include "core/robot_description.h"
#include "plan/maneuvers/maneuver_planner_settings.h"
#include "plan/perception/costmap.h"
#include "plan/routes/maneuver.h"
#include "plan/routes/route_planner.h"

namespace patrol::plan {

struct ManeuverResult {
  PlanStatus status = PlanStatus::kNoRoute;
  Maneuver maneuver = {};
  double cost_m = 0.0;   ///< weighted length
  int num_expanded = 0;  ///< states of the search
  int num_cells = 0;     ///< blocks of the distance to the goal
};

/// Returns the cost of a meter driven at a place, in meters: 1 far from obstacles, 1 + `cost_weight` at the highest
/// passable cost.
double travel_weight(const Costmap& costmap, const Eigen::Vector2d& p_map, double cost_weight);

/// Plans maneuvers of a robot with a minimum turning radius: search over position, heading and direction of travel by
/// arcs [Dolgov10], with the distance to the goal on the costmap as the estimate. Dubins paths forward and backward
/// from expanded states reach the exact goal.
class ManeuverPlanner {
 public:
  /// Throws InputError for a robot without steered wheels.
  ManeuverPlanner(const ManeuverPlannerSettings& settings, const RobotDescription& robot);

  /// Plans from the pose of the body to a goal. `is_reversing`: direction in which the robot moves now. A goal without
  /// heading (tolerance of pi) takes that of the shortest path. Returns kGoalBlocked without a search if the clearance
  /// at the goal is negative. The clearance of all poses exceeds the route margin, but within 2 m of start or goal the
  /// clearance of that end suffices, also in lethal cells around the start.
  ManeuverResult plan(const Costmap& costmap, const Pose2& T_map_body, bool is_reversing,
                      const NavigationGoal& goal) const;

  double radius_m() const { return radius_m_; }
  /// Returns the pose of the turn center in body.
  const Pose2& T_body_center() const { return T_body_center_; }

 private:
  ManeuverPlannerSettings settings_;
  double radius_m_;
  Pose2 T_body_center_;
};

}  // namespace patrol::plan
