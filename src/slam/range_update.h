#pragma once

#include <vector>

#include "core/settings.h"
#include "core/uwb.h"
#include "slam/pose_gaussian.h"

namespace patrol::slam {

struct RangeUpdateSettings {
  bool enabled = true;
  double range_std_m = 0.15;   ///< standard deviation of a LOS range: radio noise and residual calibration bias
  double gate_sigma = 3.0;       ///< ranges shorter than predicted by more standard deviations are rejected
  double nlos_gate_sigma = 2.0;  ///< ranges longer than predicted by more standard deviations are rejected as NLOS
  UwbCalibration calibration = {};  ///< bias calibration of the radio; not a scenario setting

  template <typename Self, typename Visitor>
  static void fields(Self& self, Visitor& visit) {
    visit("enabled", self.enabled);
    visit("range_std_m", self.range_std_m, between(0.001, 10.0));
    visit("gate_sigma", self.gate_sigma, between(0.5, 100.0));
    visit("nlos_gate_sigma", self.nlos_gate_sigma, between(0.5, 100.0));
  }
};

/// UWB range with the odometry at its time.
struct RangeMeasurement {
  UwbAnchor anchor;  ///< anchor in map, height above the ground of map
  double range_m = 0.0;
  Pose2 T_odom_body;
  Eigen::Vector3d p_level_antenna = Eigen::Vector3d::Zero();  ///< antenna in level, height above the ground
};

/// Difference between a measured and a predicted range.
struct RangeInnovation {
  double innovation_m = 0.0;  ///< measured minus predicted range
  double variance_m2 = 0.0;
  /// Gradient of the predicted range with respect to x, y, yaw of the current body pose.
  Eigen::Vector3d H_pose = Eigen::Vector3d::Zero();
};

/// Computes the innovation of a range. `T_odom_body` is the current odometry; the motion since the measurement is taken
/// from odometry without error.
RangeInnovation range_innovation(const PoseGaussian& now, const Pose2& T_odom_body, const RangeMeasurement& measurement,
                                 const RangeUpdateSettings& settings);

/// Returns whether the range passes the gate of line-of-sight ranges.
bool passes_gate(const RangeInnovation& innovation, const RangeUpdateSettings& settings);

/// Corrects the pose with each range in sequence (Kalman update). Returns the log probability density of the ranges,
/// which is the increment of a particle's log weight.
double update_with_ranges(const std::vector<RangeMeasurement>& measurements, const Pose2& T_odom_body,
                          const RangeUpdateSettings& settings, PoseGaussian& now);

}  // namespace patrol::slam
