#include "slam/range_update.h"

#include <cmath>
#include <numbers>

namespace patrol::slam {

RangeInnovation range_innovation(const PoseGaussian& now, const Pose2& T_odom_body, const RangeMeasurement& measurement,
                                 const RangeUpdateSettings& settings) {
  const Pose2 T_map_then = now.mean * (T_odom_body.inverse() * measurement.T_odom_body);
  const PredictedRange predicted =
      predict_uwb_range(measurement.anchor, T_map_then, measurement.p_level_antenna, settings.calibration);
  const Eigen::Vector2d back = T_map_then.position() - now.mean.position();
  RangeInnovation innovation{
      .innovation_m = measurement.range_m - predicted.range_m, .variance_m2 = 0.0, .H_pose = predicted.H_pose};
  // lever arm: rotating the current pose moves the earlier one
  innovation.H_pose.z() += predicted.H_pose.y() * back.x() - predicted.H_pose.x() * back.y();
  innovation.variance_m2 =
      innovation.H_pose.dot(now.covariance * innovation.H_pose) + settings.range_std_m * settings.range_std_m;
  return innovation;
}

bool passes_gate(const RangeInnovation& innovation, const RangeUpdateSettings& settings) {
  const double deviations = innovation.innovation_m / std::sqrt(innovation.variance_m2);
  return deviations > -settings.gate_sigma && deviations < settings.nlos_gate_sigma;
}

double update_with_ranges(const std::vector<RangeMeasurement>& measurements, const Pose2& T_odom_body,
                          const RangeUpdateSettings& settings, PoseGaussian& now) {
  double log_density = 0.0;
  for (const RangeMeasurement& measurement : measurements) {
    const RangeInnovation innovation = range_innovation(now, T_odom_body, measurement, settings);
    const Eigen::Vector3d gain = now.covariance * innovation.H_pose / innovation.variance_m2;
    now.mean = perturbed(now.mean, gain * innovation.innovation_m);
    now.covariance -= gain * innovation.variance_m2 * gain.transpose();
    log_density -= 0.5 * (innovation.innovation_m * innovation.innovation_m / innovation.variance_m2 +
                          std::log(2.0 * std::numbers::pi * innovation.variance_m2));
  }
  return log_density;
}

}  // namespace patrol::slam
