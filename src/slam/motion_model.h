#pragma once

#include "core/settings.h"
#include "slam/pose_gaussian.h"

namespace patrol::slam {

struct MotionModelSettings {
  double along_std_m_per_m = 0.01;         ///< error along the way; leg odometry: scale
  double across_std_m_per_m = 0.01;        ///< and across it: sideways slip
  double turn_std_rad_per_rad = 0.04;      ///< of the turn
  double turn_std_rad_per_m = 0.003;       ///< gained by walking
  double turn_std_rad_per_s = 0.0015;      ///< gained by standing about: the gyro's bias
  double min_std_m = 0.003;                ///< sway of the trunk, however short the way
  double min_std_rad = 0.002;

  template <typename Self, typename Visitor>
  static void fields(Self& self, Visitor& visit) {
    visit("along_std_m_per_m", self.along_std_m_per_m, at_least(0.0));
    visit("across_std_m_per_m", self.across_std_m_per_m, at_least(0.0));
    visit("turn_std_rad_per_rad", self.turn_std_rad_per_rad, at_least(0.0));
    visit("turn_std_rad_per_m", self.turn_std_rad_per_m, at_least(0.0));
    visit("turn_std_rad_per_s", self.turn_std_rad_per_s, at_least(0.0));
    visit("min_std_m", self.min_std_m, between(1e-6, 1.0));
    visit("min_std_rad", self.min_std_rad, between(1e-6, 1.0));
  }
};

/// Where odometry says that the body is now, if it was at `T_map_before` and odometry has seen it move by `T_before_now`
/// in `dt_s`.
///
/// As Thrun, Burgard, Fox, Probabilistic Robotics (2005), section 5.4, in two things different: the legs walk sideways, so
/// the motion is one move rather than turn, move, turn; and the deviations grow with the way and not with its root,
/// because the errors of legs and gyro last (scale, bias) rather than average out.
PoseGaussian predict_motion(const Pose2& T_map_before, const Pose2& T_before_now, double dt_s,
                            const MotionModelSettings& settings);

}  // namespace patrol::slam
