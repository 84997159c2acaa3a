#include "localize/calibration/odometry_calibrator.h"

#include <cmath>

#include <Eigen/Geometry>
#include <Eigen/LU>

namespace patrol::localize {
namespace {

constexpr Eigen::Index kLidarYaw = 0, kDistanceScale = 1, kRotationScale = 2;
constexpr Eigen::Index kGyroBias = 0, kGyroScale = 1;
constexpr double kGroup_s = 4.0;

Eigen::Vector2d left_of(const Eigen::Vector2d& v) { return {-v.y(), v.x()}; }

bool is_beyond(const CalibrationStep& step, double elapsed_s, const OdometryCalibratorSettings& settings) {
  return step.T_before_now_odom.position().norm() > settings.segment_m ||
         std::abs(step.T_before_now_odom.yaw) > settings.segment_rad || elapsed_s > settings.segment_s;
}

ScalarEstimate scalar(const LinearEstimate& estimate, Eigen::Index parameter, double nominal, double bias_std = 0.0) {
  return {nominal + estimate.value[parameter], std::hypot(estimate.std(parameter), bias_std)};
}

}  // namespace

OdometryCalibrator::OdometryCalibrator(const OdometryCalibratorSettings& settings, const Eigen::Vector2d& p_body_lidar)
    : settings_(settings),
      p_body_lidar_(p_body_lidar),
      odometry_(Eigen::Vector3d(settings.prior_lidar_yaw_std_rad, settings.prior_distance_scale_std,
                                settings.prior_rotation_scale_std),
                {.group_s = kGroup_s}),
      gyro_(Eigen::Vector2d(settings.prior_gyro_bias_std_radps, settings.prior_gyro_scale_std), {.group_s = kGroup_s}) {
}

void OdometryCalibrator::add(const CalibrationScan& scan, double time_offset_s, std::optional<double> gyro_yaw_rad) {
  if (!begin_ || begin_->scan.match.map != scan.match.map) {
    begin_ = SegmentBegin{scan, gyro_yaw_rad};
    return;
  }
  const double elapsed_s = to_seconds(scan.sweep.stamp - begin_->scan.sweep.stamp);
  if (!is_beyond(compare(begin_->scan, scan), elapsed_s, settings_)) return;
  add_odometry(*begin_, scan, time_offset_s);
  if (gyro_yaw_rad && begin_->gyro_yaw_rad) add_gyro(*begin_, scan, *gyro_yaw_rad, time_offset_s);
  begin_ = SegmentBegin{scan, gyro_yaw_rad};
}

void OdometryCalibrator::add_odometry(const SegmentBegin& begin, const CalibrationScan& end, double time_offset_s) {
  const CalibrationStep step = compare(begin.scan, end);
  const Eigen::Vector2d moved = step.T_before_now_odom.position();
  const double turned_rad = step.T_before_now_odom.yaw;
  LinearMeasurement measurement{
      .stamp = end.sweep.stamp, .J = Eigen::MatrixXd::Zero(3, 3), .r = step.residual, .W = {}};
  const Eigen::Vector2d lever = left_of(p_body_lidar_);
  measurement.J.col(kLidarYaw).head<2>() = -left_of(moved) + lever - Eigen::Rotation2Dd(turned_rad) * lever;
  measurement.J.col(kDistanceScale).head<2>() = moved;
  measurement.J.col(kRotationScale) << 0.5 * turned_rad * left_of(moved), turned_rad;
  measurement.r -= step.by_offset_now * (time_offset_s - end.sweep.applied_time_offset_s) -
                   step.by_offset_before * (time_offset_s - begin.scan.sweep.applied_time_offset_s);
  measurement.r += measurement.J.col(kLidarYaw) * end.sweep.applied_lidar_yaw_rad;
  const double std_m = settings_.odometry_std_m_per_m * moved.norm();
  const double std_rad =
      std::hypot(settings_.odometry_std_rad_per_m * moved.norm(), settings_.odometry_std_rad_per_rad * turned_rad);
  Eigen::Matrix3d covariance = step.match_covariance;
  covariance.diagonal() += Eigen::Vector3d(std_m, std_m, std_rad).cwiseAbs2();
  measurement.W = covariance.inverse();
  if (odometry_.distance(measurement) > settings_.outlier_sigma * settings_.outlier_sigma) return;
  odometry_.add(measurement);
}

void OdometryCalibrator::add_gyro(const SegmentBegin& begin, const CalibrationScan& end, double gyro_yaw_rad,
                                  double time_offset_s) {
  const CalibrationStep step = compare(begin.scan, end);
  const double elapsed_s = to_seconds(end.sweep.stamp - begin.scan.sweep.stamp);
  const double gyro_turn_rad = gyro_yaw_rad - *begin.gyro_yaw_rad;
  LinearMeasurement measurement{
      .stamp = end.sweep.stamp, .J = Eigen::MatrixXd(1, 2), .r = Eigen::VectorXd(1), .W = Eigen::MatrixXd(1, 1)};
  measurement.J << -elapsed_s, gyro_turn_rad;
  measurement.r << wrap_angle(step.T_before_now_match.yaw - gyro_turn_rad) -
                       step.by_offset_now.z() * (time_offset_s - end.sweep.applied_time_offset_s) +
                       step.by_offset_before.z() * (time_offset_s - begin.scan.sweep.applied_time_offset_s);
  const double variance =
      step.match_covariance(2, 2) + settings_.gyro_std_rad_per_sqrt_s * settings_.gyro_std_rad_per_sqrt_s * elapsed_s;
  measurement.W << 1.0 / variance;
  if (gyro_.distance(measurement) > settings_.outlier_sigma * settings_.outlier_sigma) {
    gyro_drift_ = {};
    return;
  }
  gyro_.add(measurement);
  gyro_drift_.yaw_rad -= measurement.r[0];
  gyro_drift_.variance_rad2 += variance;
  gyro_drift_.turned_rad += gyro_turn_rad;
  gyro_drift_.elapsed_s += elapsed_s;
  if (gyro_drift_.elapsed_s < settings_.gyro_bias_interval_s) return;
  const ScalarEstimate scale = scalar(gyro_.estimate(), kGyroScale, 1.0);
  const double std_rad = std::hypot(std::sqrt(gyro_drift_.variance_rad2), scale.std * gyro_drift_.turned_rad);
  recent_gyro_bias_ = {.value =
                           (gyro_drift_.yaw_rad + (scale.value - 1.0) * gyro_drift_.turned_rad) / gyro_drift_.elapsed_s,
                       .std = std_rad / gyro_drift_.elapsed_s};
  gyro_drift_ = {};
}

void OdometryCalibrator::interrupt() {
  begin_.reset();
  gyro_drift_ = {};
}

ScalarEstimate OdometryCalibrator::lidar_yaw_rad() const {
  return scalar(odometry_.estimate(), kLidarYaw, 0.0, settings_.lateral_bias_std_rad);
}
ScalarEstimate OdometryCalibrator::distance_scale() const {
  return scalar(odometry_.estimate(), kDistanceScale, 1.0, settings_.distance_bias_std);
}
ScalarEstimate OdometryCalibrator::rotation_scale() const { return scalar(odometry_.estimate(), kRotationScale, 1.0); }
ScalarEstimate OdometryCalibrator::gyro_bias_radps() const {
  return scalar(gyro_.estimate(), kGyroBias, 0.0, settings_.matched_rate_bias_std_radps);
}
ScalarEstimate OdometryCalibrator::gyro_scale() const {
  return scalar(gyro_.estimate(), kGyroScale, 1.0, settings_.matched_rotation_bias_std);
}

}  // namespace patrol::localize
