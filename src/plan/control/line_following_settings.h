#pragma once

#include "core/settings.h"

namespace patrol::plan {

struct LineFollowingSettings {
  double lateral_gain_per_m = 3.0;  ///< inverse of the distance over which the lateral error falls to 1/e
  double max_angle_rad = 0.5;       ///< maximum angle toward the line
  double yaw_gain_per_s = 2.0;      ///< gain from the yaw error to the yaw rate
  double max_yaw_rate_radps = 0.5;  ///< maximum yaw rate

  template <typename Self, typename Visitor>
  static void fields(Self& self, Visitor& visit) {
    visit("lateral_gain_per_m", self.lateral_gain_per_m, between(0.1, 20.0));
    visit("max_angle_rad", self.max_angle_rad, between(0.05, 1.2));
    visit("yaw_gain_per_s", self.yaw_gain_per_s, between(0.1, 10.0));
    visit("max_yaw_rate_radps", self.max_yaw_rate_radps, between(0.02, 3.0));
  }
};

}  // namespace patrol::plan
