#pragma once

#include <memory>
#include <span>
#include <string>
#include <vector>

#include "core/named_table.h"
#include "core/settings.h"
#include "plan/control/differential_approach.h"
#include "plan/control/dwa.h"
#include "plan/control/local_planner.h"
#include "plan/control/paper_dwa.h"
#include "plan/control/pose_regulator.h"
#include "plan/perception/costmap_settings.h"
#include "plan/perception/depth_points.h"
#include "plan/perception/sonar_cone.h"
#include "plan/routes/global_planner.h"

namespace patrol::plan {

struct NavigatorSettings;

/// The local planners; `make` takes the settings of its own section.
std::span<const NamedFactory<std::unique_ptr<LocalPlanner>(const NavigatorSettings&)>> local_planners();

struct NavigatorSettings {
  std::string drive = "omnidirectional";  ///< or "differential": a robot that cannot step sideways
  std::string global = "theta_star";      ///< planner of the way to the goal (plan/routes/planners.h)
  std::string local_planner = "dwa";      ///< or "paper_dwa": paper 004's, as printed
  int footprint_rows = 1;             ///< of discs that stand for the outline (plan/perception/footprint.h)
  double steps_per_s = 1e7;               ///< cells that the robot's computer looks at in a second: a route comes so much later
  double replan_period_s = 4.0;       ///< a new path after this time, for what the map has learnt
  double check_ahead_m = 6.0;         ///< an obstacle on the path nearer than this calls for a new one at once
  double stray_m = 0.8;               ///< so does being farther than this from it
  double approach_m = 0.4;            ///< from here on the goal is approached by itself, whatever the path
  double approach_decel_mps2 = 0.3;   ///< speed on the way falls so that the robot can stop at the goal
  double turn_first_rad = 1.0;        ///< the path leads off by more than this: turn in place first
  double turn_rate_radps = 0.7;
  double patience_s = 6.0;            ///< standing blocked for so long calls for a recovery
  double stuck_s = 15.0;              ///< so does moving for so long without getting half a metre away
  double detour_after_s = 0.0;        ///< what has newly come into the way is waited for so long: people walk on
  double newcomer_distance_m = 0.0;   ///< something the map does not know, nearer ahead than this, calls for caution; 0: never
  double newcomer_speed_mps = 0.4;    ///< no faster then: it may be somebody who walks
  double no_route_s = 600.0;          ///< after so long without any route the goal is given up
  std::vector<std::string> recoveries = {"back_up"};  ///< in turn: wait, clear, back_up, look_around; then a new path
  double back_up_s = 2.0;             ///< backwards, if there is room
  double back_up_speed_mps = 0.15;
  int max_recoveries = 8;             ///< without getting nearer; then the goal is given up
  CostmapSettings costmap;
  DepthPointsSettings depth;
  SonarConeSettings sonar;
  GlobalPlannerSettings routes;
  DwaSettings local;
  PaperDwaSettings paper_local;
  PoseRegulatorSettings approach;                      ///< of an omnidirectional robot
  DifferentialApproachSettings differential_approach;  ///< of a differential one

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
