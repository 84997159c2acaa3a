#pragma once

#include <algorithm>
#include <cmath>
#include <vector>

#include <Eigen/Core>

#include "core/frames.h"

/// Measurement model of ultra-wideband (UWB) ranges, shared by filters and particle filters.
namespace patrol {

struct UwbAnchor {
  int number = 0;
  /// Antenna position in a frame named by the user of the struct (site or map).
  Eigen::Vector3d p_m = Eigen::Vector3d::Zero();
};

/// Calibration of line-of-sight ranges: reading = distance + distance-dependent bias + noise. Without line of sight the
/// reading is larger. The default bias is that of an uncorrected DW1000 in channel 2 (Decawave application note APS011,
/// table 2: 500 MHz, 64 MHz pulse repetition frequency). Received levels are converted to distances with free-space
/// loss from -41.3 dBm/MHz.
struct UwbCalibration {
  /// Piecewise linear bias over increasing distances, constant beyond both ends; empty: no bias.
  std::vector<double> distance_m = {1.3, 2.1, 3.2, 5.1, 8.1, 10.2, 12.9, 20.4, 32.3, 51.2};
  std::vector<double> bias_m = {-0.110, -0.100, -0.082, -0.051, 0.0, 0.021, 0.035, 0.049, 0.071, 0.081};
  double range_std_m = 0.1;
};

struct UwbBias {
  double bias_m = 0.0;
  double slope = 0.0;  ///< derivative of the bias with respect to distance, m/m
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

/// Returns the antenna position in `level`, raised by the height of the body above the origin of map. Roll and pitch
/// are from odometry; the pose hypothesis provides x, y and yaw.
inline Eigen::Vector3d uwb_antenna_in_level(const Eigen::Quaterniond& R_odom_body, const Pose3& T_body_uwb,
                                            double z_m) {
  const Eigen::Quaterniond tilt = quaternion_from_yaw(-to_yaw(R_odom_body)) * R_odom_body;
  return tilt * T_body_uwb.position + Eigen::Vector3d(0.0, 0.0, z_m);
}

struct PredictedRange {
  double range_m = 0.0;                              ///< predicted reading, including the bias
  Eigen::Vector3d H_pose = Eigen::Vector3d::Zero();  ///< gradient with respect to x, y (m/m) and yaw (m/rad)
  double H_z = 0.0;                                  ///< derivative with respect to the height of the body
};

/// Predicts the reading of the range to an anchor in `map` for a robot pose.
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
  predicted.H_pose = {slope.x(), slope.y(), slope.y() * lever.x() - slope.x() * lever.y()};
  predicted.H_z = slope.z();
  return predicted;
}

}  // namespace patrol
