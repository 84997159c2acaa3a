#pragma once

#include "plan/navigation/navigator.h"

namespace patrol::plan {

/// What a robot of 1.0 by 0.7 m on tracks needs other than the quadruped.
inline NavigatorSettings make_tracked_settings() {
  NavigatorSettings settings;
  settings.drive = "differential";
  settings.footprint_rows = 2;
  settings.approach_m = 0.8;
  settings.approach_decel_mps2 = 0.25;
  settings.turn_first_rad = 0.8;
  settings.turn_rate_radps = 0.5;
  settings.stuck_s = 40.0;
  settings.detour_after_s = 4.0;
  settings.no_route_s = 45.0;
  settings.recoveries = {"wait", "back_up", "look_around"};
  settings.max_recoveries = 6;
  settings.costmap.route_margin_m = 0.08;
  settings.costmap.map_slack_cells = 1;
  settings.costmap.inflation_radius_m = 1.2;
  settings.local.max_accel_mps2 = 0.5;
  settings.local.max_yaw_rate_radps = 0.6;
  settings.local.max_yaw_accel_radps2 = 1.5;
  return settings;
}

}  // namespace patrol::plan
