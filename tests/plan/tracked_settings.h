#pragma once

#include "plan/navigation/navigator.h"

namespace patrol::plan {

/// Settings of a robot of 1.0 by 0.7 m on tracks that differ from those of the quadruped.
inline NavigatorSettings make_tracked_settings() {
  NavigatorSettings settings;
  settings.kinematics = "differential";
  settings.footprint_rows = 2;
  settings.goal_approach_distance_m = 0.8;
  settings.approach_deceleration_mps2 = 0.25;
  settings.turn_in_place_threshold_rad = 0.8;
  settings.turn_in_place_rate_radps = 0.5;
  settings.no_progress_timeout_s = 40.0;
  settings.new_obstacle_wait_s = 4.0;
  settings.no_path_timeout_s = 45.0;
  settings.recovery.behaviors = {"wait", "back_up", "spin"};
  settings.recovery.max_attempts = 6;
  settings.costmap.route_margin_m = 0.08;
  settings.costmap.map_match_tolerance_cells = 1;
  settings.costmap.inflation_radius_m = 1.2;
  settings.local_planner.dwa.max_acceleration_mps2 = 0.5;
  settings.local_planner.dwa.max_yaw_rate_radps = 0.6;
  settings.local_planner.dwa.max_yaw_acceleration_radps2 = 1.5;
  return settings;
}

}  // namespace patrol::plan
