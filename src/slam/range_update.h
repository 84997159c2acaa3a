#pragma once

#include <vector>

#include "core/settings.h"
#include "core/uwb.h"
#include "slam/pose_gaussian.h"
#include "slam/range_update_settings.h"

namespace patrol::slam {

/// UWB range with the odometry at its time.
struct RangeMeasurement {
  UwbAnchor anchor;  ///< anchor in survey, which is close to map; height above the ground of map
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
