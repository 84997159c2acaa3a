#pragma once

#include "core/settings.h"

namespace patrol::slam {

/// Settings of the position factors of a pose graph.
struct PositionFactorsSettings {
  bool enabled = true;                  ///< use of position measurements in the pose graph
  double survey_position_std_m = 0.02;  ///< standard deviation of the position of survey in map before the first factor
  double survey_yaw_std_rad = 0.01;     ///< standard deviation of the yaw of survey in map before the first factor
  double min_interval_s = 1.0;          ///< minimum time between two positions

  template <typename Self, typename Visitor>
  static void fields(Self& self, Visitor& visit) {
    visit("enabled", self.enabled);
    visit("survey_position_std_m", self.survey_position_std_m, between(1e-4, 1e3));
    visit("survey_yaw_std_rad", self.survey_yaw_std_rad, between(1e-5, 10.0));
    visit("min_interval_s", self.min_interval_s, between(0.0, 1e3));
  }
};

}  // namespace patrol::slam
