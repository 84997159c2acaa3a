#include "localize/calibration/time_offset_estimator.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include <Eigen/LU>

namespace patrol::localize {
namespace {

constexpr std::size_t kMinRecent = 20;   // minimum number of comparisons that detect a step
constexpr double kRecentVariance = 4.0;  // variance factor of the newest scans alone, for correlated errors

}  // namespace

bool is_applicable(const TimeOffset& estimate, double applied_s, double max_std_s) {
  constexpr double kClearDifference_sigma = 5.0;
  return estimate.std_s <= max_std_s ||
         std::abs(estimate.value_s - applied_s) > kClearDifference_sigma * estimate.std_s;
}

TimeOffsetEstimator::TimeOffsetEstimator(const TimeOffsetEstimatorSettings& settings)
    : settings_(settings), filter_(Eigen::Vector2d(settings.prior_std_s, settings.prior_drift_std_s_per_s), {}) {}

void TimeOffsetEstimator::add(const CalibrationScan& scan) {
  const std::optional<CalibrationScan> before = std::exchange(last_, scan);
  if (!before || before->match.map != scan.match.map) return;
  const double gap_s = to_seconds(scan.sweep.stamp - before->sweep.stamp);
  if (gap_s <= 0.0 || gap_s > settings_.max_gap_s) return;
  if (!origin_) origin_ = scan.sweep.stamp;

  const CalibrationStep step = compare(*before, scan);
  const double elapsed_s = to_seconds(scan.sweep.stamp - *origin_);
  LinearMeasurement measurement{.stamp = scan.sweep.stamp, .J = Eigen::MatrixXd(3, 2), .r = step.residual, .W = {}};
  const Eigen::Vector3d by_offset = step.by_offset_now - step.by_offset_before;
  measurement.J << by_offset, elapsed_s * by_offset;
  measurement.r += step.by_offset_now * scan.sweep.applied_time_offset_s -
                   step.by_offset_before * before->sweep.applied_time_offset_s;
  Eigen::Matrix3d covariance = step.match_covariance;
  covariance.diagonal() +=
      Eigen::Vector3d(settings_.odometry_std_m, settings_.odometry_std_m, settings_.odometry_std_rad).cwiseAbs2();
  const double remaining_s =
      settings_.linearization_error * (at(scan.sweep.stamp).value_s - scan.sweep.applied_time_offset_s);
  const double root = std::sqrt(settings_.translation_variance_factor);
  const Eigen::Vector3d scale(root, root, 1.0);
  covariance = scale.asDiagonal() * covariance * scale.asDiagonal();
  covariance += remaining_s * remaining_s * by_offset * by_offset.transpose();
  measurement.W = covariance.inverse();
  detect_step(measurement);
  if (filter_.distance(measurement) > settings_.outlier_sigma * settings_.outlier_sigma) return;
  filter_.add(measurement);
}

void TimeOffsetEstimator::detect_step(const LinearMeasurement& measurement) {
  const Eigen::VectorXd by_offset = measurement.J.col(0);
  const double weight =
      std::min(1.0, settings_.outlier_sigma * settings_.outlier_sigma / filter_.distance(measurement));
  recent_.push_back({.stamp = measurement.stamp,
                     .information = weight * by_offset.dot(measurement.W * by_offset),
                     .information_offset = weight * by_offset.dot(measurement.W * measurement.r)});
  while (recent_.front().stamp < measurement.stamp - from_seconds(settings_.step_window_s)) recent_.pop_front();
  if (recent_.size() < kMinRecent) return;
  double information = 0.0, information_offset = 0.0;
  for (const Term& term : recent_) {
    information += term.information;
    information_offset += term.information_offset;
  }
  if (information <= 0.0) return;  // the velocity has not changed
  const TimeOffset now = at(measurement.stamp);
  const double difference_s = std::abs(information_offset / information - now.value_s);
  const double std_s = std::sqrt(kRecentVariance / information + now.std_s * now.std_s);
  if (difference_s < std::max(settings_.min_step_s, settings_.step_sigma * std_s)) return;
  ++num_steps_;
  filter_.reset();
  recent_.clear();
  origin_ = measurement.stamp;
}

TimeOffset TimeOffsetEstimator::at(Time stamp) const {
  const LinearEstimate estimate = filter_.estimate();
  const double elapsed_s = origin_ ? to_seconds(stamp - *origin_) : 0.0;
  const Eigen::Vector2d by(1.0, elapsed_s);
  // The lag may differ between the beginning and the end.
  const double lag_drift_std = std::min(settings_.prior_drift_std_s_per_s,
                                        std::numbers::sqrt2 * settings_.odometry_lag_std_s / std::max(elapsed_s, 1.0));
  const double noise_std_s = std::sqrt(by.dot(estimate.covariance * by));
  return {.value_s = by.dot(estimate.value),
          .std_s = std::hypot(noise_std_s, settings_.odometry_lag_std_s),
          .noise_std_s = noise_std_s,
          .drift_s_per_s = estimate.value[1],
          .drift_std_s_per_s = std::hypot(estimate.std(1), lag_drift_std)};
}

}  // namespace patrol::localize
