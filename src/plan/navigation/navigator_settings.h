#pragma once

#include <memory>
#include <span>
#include <string>
#include <vector>

#include "core/named_table.h"
#include "core/settings.h"
#include "plan/control/differential_pose_controller.h"
#include "plan/control/dwa.h"
#include "plan/control/local_planner.h"
#include "plan/control/dwa_liu21.h"
#include "plan/control/pose_regulator.h"
#include "plan/perception/costmap_settings.h"
#include "plan/perception/depth_obstacles.h"
#include "plan/perception/sonar_cone.h"
#include "plan/routes/global_planner.h"

namespace patrol::plan {

struct NavigatorSettings;

/// Table of local planners; `make` takes the settings of its own section.
std::span<const NamedFactory<std::unique_ptr<LocalPlanner>(const NavigatorSettings&)>> local_planners();

struct NavigatorSettings {
  std::string drive = "omnidirectional";  ///< or "differential": a robot that cannot move sideways
  std::string global = "theta_star";      ///< global planner (plan/routes/planners.h)
  std::string local_planner = "dwa";      ///< or "paper_dwa": as printed in [Liu21]
  int footprint_rows = 1;             ///< rows of discs that cover the outline (plan/perception/footprint.h)
  double steps_per_s = 1e7;               ///< cells expanded per second by the robot's computer; delays each route
  double replan_period_s = 4.0;       ///< period of replanning after map changes
  double check_ahead_m = 6.0;         ///< range of path checks; an obstacle on the path within it triggers replanning
  double stray_m = 0.8;               ///< distance from the path that triggers replanning
  double approach_m = 0.4;            ///< distance from the goal at which the goal controller takes over
  double approach_decel_mps2 = 0.3;   ///< deceleration by which the speed falls toward the goal
  double turn_first_rad = 1.0;        ///< path direction relative to the heading from which the robot turns in place
  double turn_rate_radps = 0.7;
  double patience_s = 6.0;            ///< time blocked before a recovery begins
  double stuck_s = 15.0;              ///< time within half a meter before a recovery begins
  double detour_after_s = 0.0;        ///< wait before replanning around a new obstacle, which may be a pedestrian
  double newcomer_distance_m = 0.0;   ///< distance ahead within which an unmapped obstacle limits the speed; 0: never
  double newcomer_speed_mps = 0.4;    ///< speed limit before an unmapped obstacle, which may be a pedestrian
  double no_route_s = 600.0;          ///< time without any route after which the goal is aborted
  std::vector<std::string> recoveries = {"back_up"};  ///< in order: wait, clear, back_up, look_around
  double back_up_s = 2.0;             ///< duration of backing up, if there is room
  double back_up_speed_mps = 0.15;
  int max_recoveries = 8;             ///< recoveries without progress after which the goal is aborted
  CostmapSettings costmap;
  DepthPointsSettings depth;
  SonarConeSettings sonar;
  GlobalPlannerSettings routes;
  DwaSettings local;
  PaperDwaSettings paper_local;
  PoseRegulatorSettings approach;                      ///< goal controller of an omnidirectional robot
  DifferentialApproachSettings differential_approach;  ///< goal controller of a differential robot

  template <typename Self, typename Visitor>
  static void fields(Self& self, Visitor& visit) {
    visit("drive", self.drive, one_of({"omnidirectional", "differential"}));
    visit("global", self.global, one_of(drivable_route_planners()));
    visit("local_planner", self.local_planner, one_of(local_planners()));
    visit("footprint_rows", self.footprint_rows, between(1, 4));
    visit("steps_per_s", self.steps_per_s, between(1e3, 1e12));
    visit("replan_period_s", self.replan_period_s, between(0.1, 600.0));
    visit("check_ahead_m", self.check_ahead_m, between(0.5, 100.0));
    visit("stray_m", self.stray_m, between(0.1, 10.0));
    visit("approach_m", self.approach_m, between(0.05, 3.0));
    visit("approach_decel_mps2", self.approach_decel_mps2, between(0.05, 5.0));
    visit("turn_first_rad", self.turn_first_rad, between(0.2, 3.2));
    visit("turn_rate_radps", self.turn_rate_radps, between(0.05, 3.0));
    visit("patience_s", self.patience_s, between(0.5, 600.0));
    visit("stuck_s", self.stuck_s, between(1.0, 600.0));
    visit("detour_after_s", self.detour_after_s, between(0.0, 60.0));
    visit("newcomer_distance_m", self.newcomer_distance_m, between(0.0, 10.0));
    visit("newcomer_speed_mps", self.newcomer_speed_mps, between(0.05, 5.0));
    visit("no_route_s", self.no_route_s, between(0.5, 3600.0));
    visit("recoveries", self.recoveries, one_of({"wait", "clear", "back_up", "look_around"}));
    visit("back_up_s", self.back_up_s, between(0.0, 20.0));
    visit("back_up_speed_mps", self.back_up_speed_mps, between(0.0, 1.0));
    visit("max_recoveries", self.max_recoveries, between(0, 1000));
    visit("costmap", self.costmap);
    visit("depth", self.depth);
    visit("sonar", self.sonar);
    visit("routes", self.routes);
    visit("local", self.local);
    visit("paper_local", self.paper_local);
    visit("approach", self.approach);
    visit("differential_approach", self.differential_approach);
  }
};

}  // namespace patrol::plan
