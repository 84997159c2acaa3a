#pragma once

#include "core/settings.h"

namespace patrol::plan {

struct DockPoseFilterSettings {
  double position_std_m_per_m = 0.03;  ///< odometry drift between two detections
  double yaw_std_rad_per_rad = 0.05;
  double yaw_std_rad_per_m = 0.01;
  double yaw_random_walk_rad_per_sqrt_s = 0.003;  ///< drift of the gyro bias, also at rest
  double lateral_std_m_per_rad = 0.03;            ///< sideways displacement during a skidding turn
  double min_std_m = 0.002;                       ///< minimum std of a detection: errors common to one pose
  double min_std_rad = 0.002;
  double gate = 16.0;  ///< squared Mahalanobis distance from which a detection is an outlier

  template <typename Self, typename Visitor>
  static void fields(Self& self, Visitor& visit) {
    visit("position_std_m_per_m", self.position_std_m_per_m, between(0.0, 1.0));
    visit("yaw_std_rad_per_rad", self.yaw_std_rad_per_rad, between(0.0, 1.0));
    visit("yaw_std_rad_per_m", self.yaw_std_rad_per_m, between(0.0, 1.0));
    visit("yaw_random_walk_rad_per_sqrt_s", self.yaw_random_walk_rad_per_sqrt_s, between(0.0, 1.0));
    visit("lateral_std_m_per_rad", self.lateral_std_m_per_rad, between(0.0, 1.0));
    visit("min_std_m", self.min_std_m, between(1e-4, 0.1));
    visit("min_std_rad", self.min_std_rad, between(1e-4, 0.1));
    visit("gate", self.gate, between(1.0, 1000.0));
  }
};

}  // namespace patrol::plan
