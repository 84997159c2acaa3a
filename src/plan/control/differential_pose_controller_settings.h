#pragma once

#include "core/settings.h"
#include "plan/control/line_following_settings.h"

namespace patrol::plan {

struct DifferentialPoseControllerSettings {
  double speed_gain_per_s = 1.0;        ///< speed per meter of remaining distance
  double max_speed_mps = 0.3;           ///< maximum speed
  double min_speed_mps = 0.04;          ///< minimum speed that the tracks follow smoothly
  double min_yaw_rate_radps = 0.08;     ///< minimum yaw rate that the tracks follow smoothly
  double tolerance_fraction = 0.5;      ///< fraction of the goal's tolerances that a pass aims at
  double max_reverse_distance_m = 1.0;  ///< maximum distance of a goal behind the robot that is approached in reverse
  double lateral_correction_distance_m = 0.25;  ///< distance below which lateral errors are corrected by backing up
  double max_back_off_m = 0.8;                  ///< maximum distance of one backing-up maneuver
  LineFollowingSettings line;

  template <typename Self, typename Visitor>
  static void fields(Self& self, Visitor& visit) {
    visit("speed_gain_per_s", self.speed_gain_per_s, between(0.1, 10.0));
    visit("max_speed_mps", self.max_speed_mps, between(0.02, 2.0));
    visit("min_speed_mps", self.min_speed_mps, between(0.005, 0.5));
    visit("min_yaw_rate_radps", self.min_yaw_rate_radps, between(0.01, 1.0));
    visit("tolerance_fraction", self.tolerance_fraction, between(0.1, 1.0));
    visit("max_reverse_distance_m", self.max_reverse_distance_m, between(0.0, 5.0));
    visit("lateral_correction_distance_m", self.lateral_correction_distance_m, between(0.05, 1.0));
    visit("max_back_off_m", self.max_back_off_m, between(0.2, 3.0));
    visit("line", self.line);
  }
};

}  // namespace patrol::plan
