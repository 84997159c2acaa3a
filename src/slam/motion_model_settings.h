#pragma once

#include "core/settings.h"

namespace patrol::slam {

/// Noise of the motion measured by odometry.
struct MotionModelSettings {
  /// Standard deviation of the distance along the motion; for leg odometry: scale error.
  double longitudinal_std_m_per_m = 0.01;
  double lateral_std_m_per_m = 0.01;  ///< standard deviation across the motion: lateral slip
  double yaw_std_rad_per_rad = 0.04;  ///< standard deviation of the yaw change per yaw change
  double yaw_std_rad_per_m = 0.003;   ///< standard deviation of yaw per distance traveled
  double yaw_std_rad_per_s = 0.0015;  ///< standard deviation of yaw per time: gyro bias
  double min_std_m = 0.003;           ///< minimum standard deviation of the position: sway of the trunk
  double min_std_rad = 0.002;         ///< minimum standard deviation of the yaw of a motion

  template <typename Self, typename Visitor>
  static void fields(Self& self, Visitor& visit) {
    visit("longitudinal_std_m_per_m", self.longitudinal_std_m_per_m, at_least(0.0));
    visit("lateral_std_m_per_m", self.lateral_std_m_per_m, at_least(0.0));
    visit("yaw_std_rad_per_rad", self.yaw_std_rad_per_rad, at_least(0.0));
    visit("yaw_std_rad_per_m", self.yaw_std_rad_per_m, at_least(0.0));
    visit("yaw_std_rad_per_s", self.yaw_std_rad_per_s, at_least(0.0));
    visit("min_std_m", self.min_std_m, between(1e-6, 1.0));
    visit("min_std_rad", self.min_std_rad, between(1e-6, 1.0));
  }
};

}  // namespace patrol::slam
