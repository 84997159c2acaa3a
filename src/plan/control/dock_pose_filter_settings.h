#pragma once

#include "core/settings.h"

namespace patrol::plan {

struct DockPoseFilterSettings {
  double position_std_m_per_m = 0.03;             ///< drift of odometry between two detections, per distance
  double yaw_std_rad_per_rad = 0.05;              ///< drift of the yaw of odometry per rotation
  double yaw_std_rad_per_m = 0.01;                ///< drift of the yaw of odometry per distance
  double yaw_random_walk_rad_per_sqrt_s = 0.003;  ///< drift of the gyro bias, also at rest
  double lateral_std_m_per_rad = 0.03;            ///< sideways displacement during a skidding turn
  double min_std_m = 0.002;    ///< minimum standard deviation of the position of a detection: errors common to one pose
  double min_std_rad = 0.002;  ///< minimum standard deviation of the yaw of a detection
  double gate = 16.0;          ///< squared Mahalanobis distance from which a detection is an outlier

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
