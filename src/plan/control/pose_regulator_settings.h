#pragma once

#include "core/settings.h"

namespace patrol::plan {

struct PoseRegulatorSettings {
  double position_gain_per_s = 1.2;     ///< gain from the position error to the speed
  double yaw_gain_per_s = 1.5;          ///< gain from the yaw error to the yaw rate
  double max_speed_mps = 0.25;          ///< maximum forward and backward speed
  double max_lateral_speed_mps = 0.15;  ///< maximum lateral speed
  double max_yaw_rate_radps = 0.6;      ///< maximum yaw rate

  template <typename Self, typename Visitor>
  static void fields(Self& self, Visitor& visit) {
    visit("position_gain_per_s", self.position_gain_per_s, between(0.1, 10.0));
    visit("yaw_gain_per_s", self.yaw_gain_per_s, between(0.1, 10.0));
    visit("max_speed_mps", self.max_speed_mps, between(0.02, 2.0));
    visit("max_lateral_speed_mps", self.max_lateral_speed_mps, between(0.0, 2.0));
    visit("max_yaw_rate_radps", self.max_yaw_rate_radps, between(0.02, 3.0));
  }
};

}  // namespace patrol::plan
