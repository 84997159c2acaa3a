#pragma once

#include <string>

#include "core/settings.h"
#include "plan/maneuvers/maneuver_planner_settings.h"
#include "plan/navigation/goal_controller_settings.h"
#include "plan/navigation/local_planner_settings.h"
#include "plan/navigation/recovery_settings.h"
#include "plan/perception/costmap_settings.h"
#include "plan/perception/depth_obstacles_settings.h"
#include "plan/perception/sonar_cone_settings.h"
#include "plan/routes/global_planner.h"

namespace patrol::plan {

struct NavigatorSettings {
  /// Motion that the robot can execute: "omnidirectional", "differential" for a robot that cannot move sideways, or
  /// "ackermann" for a robot with steered wheels, which cannot turn in place.
  std::string kinematics = "omnidirectional";
  int footprint_rows = 1;              ///< rows of discs that cover the outline (plan/perception/footprint.h)
  double planner_cells_per_s = 1e7;    ///< cells expanded per second by the robot's computer; delays each path
  double replan_period_s = 4.0;        ///< period of replanning after map changes
  double path_check_distance_m = 6.0;  ///< range of path checks; an obstacle on the path within it triggers replanning
  double max_path_deviation_m = 0.8;   ///< distance from the path that triggers replanning
  double goal_approach_distance_m = 0.4;    ///< distance from the goal at which the goal controller takes over
  double approach_deceleration_mps2 = 0.3;  ///< deceleration by which the speed falls toward the goal
  /// Path direction relative to the heading from which the robot turns in place.
  double turn_in_place_threshold_rad = 1.0;
  double turn_in_place_rate_radps = 0.7;  ///< yaw rate of a turn in place
  double blocked_timeout_s = 6.0;         ///< time blocked before a recovery begins
  double no_progress_timeout_s = 15.0;    ///< time within half a meter before a recovery begins
  double new_obstacle_wait_s = 0.0;       ///< wait before replanning around a new obstacle, which may be a pedestrian
  /// Distance ahead within which an unmapped obstacle limits the speed; 0: never.
  double unmapped_obstacle_slowdown_distance_m = 0.0;
  double unmapped_obstacle_max_speed_mps = 0.4;  ///< limit before an unmapped obstacle, which may be a pedestrian
  double no_path_timeout_s = 600.0;              ///< time without any path after which the goal is aborted
  RecoverySettings recovery;
  CostmapSettings costmap;
  DepthObstaclesSettings depth_obstacles;
  SonarConeSettings sonar_obstacles;
  GlobalPlannerSettings global_planner;
  ManeuverPlannerSettings maneuver_planner;  ///< planner of a robot with steered wheels
  LocalPlannerSettings local_planner;
  GoalControllerSettings goal_controller;

  template <typename Self, typename Visitor>
  static void fields(Self& self, Visitor& visit) {
    visit("kinematics", self.kinematics, one_of({"omnidirectional", "differential", "ackermann"}));
    visit("footprint_rows", self.footprint_rows, between(1, 4));
    visit("planner_cells_per_s", self.planner_cells_per_s, between(1e3, 1e12));
    visit("replan_period_s", self.replan_period_s, between(0.1, 600.0));
    visit("path_check_distance_m", self.path_check_distance_m, between(0.5, 100.0));
    visit("max_path_deviation_m", self.max_path_deviation_m, between(0.1, 10.0));
    visit("goal_approach_distance_m", self.goal_approach_distance_m, between(0.05, 3.0));
    visit("approach_deceleration_mps2", self.approach_deceleration_mps2, between(0.05, 5.0));
    visit("turn_in_place_threshold_rad", self.turn_in_place_threshold_rad, between(0.2, 3.2));
    visit("turn_in_place_rate_radps", self.turn_in_place_rate_radps, between(0.05, 3.0));
    visit("blocked_timeout_s", self.blocked_timeout_s, between(0.5, 600.0));
    visit("no_progress_timeout_s", self.no_progress_timeout_s, between(1.0, 600.0));
    visit("new_obstacle_wait_s", self.new_obstacle_wait_s, between(0.0, 60.0));
    visit("unmapped_obstacle_slowdown_distance_m", self.unmapped_obstacle_slowdown_distance_m, between(0.0, 10.0));
    visit("unmapped_obstacle_max_speed_mps", self.unmapped_obstacle_max_speed_mps, between(0.05, 5.0));
    visit("no_path_timeout_s", self.no_path_timeout_s, between(0.5, 3600.0));
    visit("recovery", self.recovery);
    visit("costmap", self.costmap);
    visit("depth_obstacles", self.depth_obstacles);
    visit("sonar_obstacles", self.sonar_obstacles);
    visit("global_planner", self.global_planner);
    visit("maneuver_planner", self.maneuver_planner);
    visit("local_planner", self.local_planner);
    visit("goal_controller", self.goal_controller);
  }
};

}  // namespace patrol::plan
