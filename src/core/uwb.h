#pragma once

#include <Eigen/Core>

#include <algorithm>
#include <cmath>
#include <vector>

#include "core/frames.h"

/// The measurement model of an ultra-wideband range, for whoever has a pose to weigh: filters and particles alike.
namespace patrol {

struct UwbAnchor {
  int number = 0;
  Eigen::Vector3d p_m = Eigen::Vector3d::Zero();  ///< antenna, in the frame that the text says (site, map)
};

/// What a clear range reads at a true distance: the distance, a bias that goes with it, and noise. Off the line of sight it reads
/// more. The default bias is that of an uncorrected DW1000 in channel 2 (Decawave application note APS011, table 2: 500 MHz,
/// 64 MHz pulse repetition; distance by the level that free space leaves of -41.3 dBm/MHz).
struct UwbCalibration {
  /// Piecewise linear over growing distances, level before the first and after the last; empty: no bias.
  std::vector<double> distance_m = {1.3, 2.1, 3.2, 5.1, 8.1, 10.2, 12.9, 20.4, 32.3, 51.2};
  std::vector<double> bias_m = {-0.110, -0.100, -0.082, -0.051, 0.0, 0.021, 0.035, 0.049, 0.071, 0.081};
  double range_std_m = 0.1;
};

struct UwbBias {
  double bias_m = 0.0;
  double slope = 0.0;  ///< m per m of distance
};

inline UwbBias uwb_bias_at(const UwbCalibration& calibration, double distance_m) {
  const std::vector<double>&x = calibration.distance_m, &y = calibration.bias_m;
  if (x.empty()) return {};
  const auto above = static_cast<std::size_t>(std::upper_bound(x.begin(), x.end(), distance_m) - x.begin());
  if (above == 0) return {.bias_m = y.front()};
  if (above == x.size()) return {.bias_m = y.back()};
  const double slope = (y[above] - y[above - 1]) / (x[above] - x[above - 1]);
  return {.bias_m = y[above - 1] + slope * (distance_m - x[above - 1]), .slope = slope};
}

/// The antenna's place in `level`, lifted by the height of the body above map's origin: roll and pitch are odometry's, x, y and
/// yaw the hypothesis'.
inline Eigen::Vector3d uwb_antenna_in_level(const Eigen::Quaterniond& R_odom_body, const Pose3& T_body_uwb, double z_m) {
  const Eigen::Quaterniond tilt = quaternion_from_yaw(-yaw_of(R_odom_body)) * R_odom_body;
  return tilt * T_body_uwb.position + Eigen::Vector3d(0.0, 0.0, z_m);
}

struct PredictedRange {
  double range_m = 0.0;                               ///< as it would be read
  Eigen::Vector3d by_pose = Eigen::Vector3d::Zero();  ///< its gradient by x, y (m/m) and yaw (m/rad)
  double by_z = 0.0;                                  ///< and by the body's height
};

/// The range that a robot at this pose would read from an anchor in `map`.
inline PredictedRange predict_uwb_range(const UwbAnchor& anchor_in_map, const Pose2& T_map_body,
                                        const Eigen::Vector3d& p_level_antenna, const UwbCalibration& calibration) {
  const Eigen::Vector2d lever = T_map_body * Eigen::Vector2d(p_level_antenna.head<2>()) - T_map_body.position();
  Eigen::Vector3d anchor_to_antenna(T_map_body.x + lever.x(), T_map_body.y + lever.y(), p_level_antenna.z());
  anchor_to_antenna -= anchor_in_map.p_m;
  const double distance = anchor_to_antenna.norm();
  const UwbBias bias = uwb_bias_at(calibration, distance);
  PredictedRange predicted{.range_m = distance + bias.bias_m};
  if (distance < 1e-9) return predicted;
  const Eigen::Vector3d slope = (1.0 + bias.slope) / distance * anchor_to_antenna;
  predicted.by_pose = {slope.x(), slope.y(), slope.y() * lever.x() - slope.x() * lever.y()};
  predicted.by_z = slope.z();
  return predicted;
}

}  // namespace patrol
