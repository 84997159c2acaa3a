#include "slam/graph/odometry_correction.h"

#include <algorithm>
#include <cmath>

namespace patrol::slam {
namespace {

/// Random walk of the values, variance per meter.
constexpr double kDriftPerMeter = 1e-6;
/// Shortest motion that says something: distance plus turn at 1 m.
constexpr double kMinMotion_m = 0.005;
constexpr double kOdometryDegreesOfFreedom = 4.0;

/// Factor of the variance of a measurement with this squared normalized residual.
double variance_factor(double squared) {
  return (kOdometryDegreesOfFreedom + squared) / (kOdometryDegreesOfFreedom + 1.0);
}

}  // namespace

Pose2 OdometryCorrection::corrected(const Pose2& T_before_now) const {
  const double distance_m = std::copysign(T_before_now.position().norm(), T_before_now.x);
  const double yaw = values_.turn_scale * T_before_now.yaw + values_.steering_rad_per_m * distance_m;
  // The chord of an arc points half of the turn aside.
  const Eigen::Vector2d moved =
      values_.distance_scale * (Eigen::Rotation2Dd(0.5 * (yaw - T_before_now.yaw)) * T_before_now.position());
  return {moved.x(), moved.y(), wrap_angle(yaw)};
}

void OdometryCorrection::update(const Pose2& odometry, const Pose2& matched, const Noise& noise,
                                bool is_distance_determined) {
  const double distance_m = std::copysign(odometry.position().norm(), odometry.x);
  if (std::abs(distance_m) + std::abs(odometry.yaw) < kMinMotion_m) return;
  const double drift = kDriftPerMeter * std::abs(distance_m);
  turn_covariance_.diagonal().array() += drift;
  const Eigen::Vector2d row(odometry.yaw, distance_m);
  const double turn_residual =
      wrap_angle(matched.yaw - values_.turn_scale * odometry.yaw - values_.steering_rad_per_m * distance_m);
  const double spread = row.dot(turn_covariance_ * row);
  const double turn_variance =
      spread + noise.std_rad * noise.std_rad *
                   variance_factor(turn_residual * turn_residual / (spread + noise.std_rad * noise.std_rad));
  const Eigen::Vector2d gain = turn_covariance_ * row / turn_variance;
  values_.turn_scale += gain.x() * turn_residual;
  values_.steering_rad_per_m += gain.y() * turn_residual;
  turn_covariance_ -= gain * row.transpose() * turn_covariance_;

  if (!is_distance_determined || std::abs(distance_m) < kMinMotion_m) return;
  distance_variance_ += drift;
  const double moved_m = odometry.position().dot(matched.position()) / distance_m;
  const double residual = moved_m - values_.distance_scale * distance_m;
  const double prior = distance_m * distance_m * distance_variance_;
  const double variance =
      prior + noise.std_m * noise.std_m * variance_factor(residual * residual / (prior + noise.std_m * noise.std_m));
  const double distance_gain = distance_m * distance_variance_ / variance;
  values_.distance_scale += distance_gain * residual;
  distance_variance_ *= 1.0 - distance_gain * distance_m;
}

}  // namespace patrol::slam
