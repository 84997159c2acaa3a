#include "slam/range_update.h"

#include <cmath>
#include <numbers>

namespace patrol::slam {

RangeInnovation range_innovation(const PoseGaussian& now, const Pose2& T_odom_body, const RangeSighting& sighting,
                                 const RangeUpdateSettings& settings) {
  const Pose2 T_map_then = now.mean * (T_odom_body.inverse() * sighting.T_odom_body);
  const PredictedRange predicted = predict_uwb_range(sighting.anchor, T_map_then, sighting.p_level_antenna, settings.calibration);
  const Eigen::Vector2d back = T_map_then.position() - now.mean.position();
  RangeInnovation innovation{.excess_m = sighting.range_m - predicted.range_m, .variance_m2 = 0.0, .by_pose = predicted.by_pose};
  // lever arm: rotating the current pose moves the earlier one
  innovation.by_pose.z() += predicted.by_pose.y() * back.x() - predicted.by_pose.x() * back.y();
  innovation.variance_m2 = innovation.by_pose.dot(now.covariance * innovation.by_pose) + settings.range_std_m * settings.range_std_m;
  return innovation;
}

bool is_plausible(const RangeInnovation& innovation, const RangeUpdateSettings& settings) {
  const double deviations = innovation.excess_m / std::sqrt(innovation.variance_m2);
  return deviations > -settings.gate_std && deviations < settings.gate_excess_std;
}

double update_with_ranges(const std::vector<RangeSighting>& sightings, const Pose2& T_odom_body,
                          const RangeUpdateSettings& settings, PoseGaussian& now) {
  double log_density = 0.0;
  for (const RangeSighting& sighting : sightings) {
    const RangeInnovation innovation = range_innovation(now, T_odom_body, sighting, settings);
    const Eigen::Vector3d gain = now.covariance * innovation.by_pose / innovation.variance_m2;
    now.mean = shifted(now.mean, gain * innovation.excess_m);
    now.covariance -= gain * innovation.variance_m2 * gain.transpose();
    log_density -= 0.5 * (innovation.excess_m * innovation.excess_m / innovation.variance_m2 +
                          std::log(2.0 * std::numbers::pi * innovation.variance_m2));
  }
  return log_density;
}

}  // namespace patrol::slam
