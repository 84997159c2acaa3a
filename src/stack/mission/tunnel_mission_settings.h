#pragma once

#include <cstddef>
#include <string>

#include "core/route.h"
#include "core/settings.h"

namespace patrol::stack {

struct TunnelMissionSettings {
  /// Number of runs to all goals, each after a restart of the localization. A robot with a post that is not docked
  /// keeps its pose.
  int num_runs = 10;
  /// Whether the robot starts at its post; false: the initial pose is unknown, and the robot localizes globally.
  bool start_docked = true;
  /// Whether a robot without a post starts at the surveyed start, localizes from there, and continues between runs
  /// without a restart.
  bool start_at_survey = false;
  bool dock_after_run = true;      ///< whether the robot docks after the mapping drive and after each run
  double init_wait_s = 4.0;        ///< initial standing time, for sensors to settle and biases to be estimated
  double first_scan_wait_s = 1.5;  ///< minimum of the initial standing time after the first step; the map's first scan
                                   ///< is taken at rest
  double dwell_s = 1.0;            ///< standing time at a goal before it is reported
  double position_tolerance_m = 0.03;      ///< tolerance at a goal; the goal's own accuracy applies if tighter
  double yaw_tolerance_rad = 0.017;        ///< maximum heading error of the robot at a goal; 3 or more: any heading
  double teleop_timeout_s = 2.0;           ///< timeout after which the teleoperation counts as switched off
  double relocalization_timeout_s = 30.0;  ///< relocalization timeout; the robot stands still meanwhile
  /// Types of the goals saved on the mapping drive, in order; N for the rest. N: stop; V: pass without a stop; D: stop
  /// and scan the lining; R: stop for an operator.
  std::string goal_types = {};
  double operator_timeout_s = 120.0;  ///< timeout for teleoperation commands at a goal of type R; the robot then
                                      ///< continues autonomously

  template <typename Self, typename Visitor>
  static void fields(Self& self, Visitor& visit) {
    visit("num_runs", self.num_runs, between(0, 1000));
    visit("start_docked", self.start_docked);
    visit("start_at_survey", self.start_at_survey);
    visit("dock_after_run", self.dock_after_run);
    visit("init_wait_s", self.init_wait_s, between(0.0, 600.0));
    visit("first_scan_wait_s", self.first_scan_wait_s, between(0.0, 600.0));
    visit("dwell_s", self.dwell_s, between(0.0, 60.0));
    visit("position_tolerance_m", self.position_tolerance_m, between(0.005, 5.0));
    visit("yaw_tolerance_rad", self.yaw_tolerance_rad, between(0.002, 3.2));
    visit("teleop_timeout_s", self.teleop_timeout_s, between(0.2, 60.0));
    visit("relocalization_timeout_s", self.relocalization_timeout_s, between(1.0, 600.0));
    visit("goal_types", self.goal_types);
    visit("operator_timeout_s", self.operator_timeout_s, between(1.0, 3600.0));
  }

  /// Returns the type of the goal with this index, from 0. Throws InputError when `goal_types` contains a letter that
  /// is not in `kGoalTypes`.
  GoalType goal_type(std::size_t index) const;
};

}  // namespace patrol::stack
