#include "io/logs/gyro_odometry.h"

#include <algorithm>
#include <cmath>

namespace patrol::io {
namespace {

constexpr Time kMaxGyroGap = std::chrono::milliseconds(500);  ///< maximum time between gyro messages
constexpr Time kBufferLength =
    std::chrono::seconds(300);  ///< buffer length; must exceed the delay of scans behind the gyro
constexpr std::size_t kMaxHeadings = 300'000;
constexpr double kStationarySpeed_mps = 0.005, kStationaryRateRadps = 0.005;  ///< standstill thresholds of the odometry
constexpr double kMaxBiasRadps = 0.05;  ///< maximum gyro rate of a standstill, whatever the wheels report
constexpr double kMinStandstill_s = 1.0;
/// Minimum sum of squared yaw increments for a verdict: three rad at 1 deg per step.
constexpr double kMinSquaredYawRad2 = 0.05;
constexpr double kSlopeTolerance = 0.02, kResidualTolerance = 0.05;  ///< limits for kAgrees
constexpr double kSlopeLimit = 0.5, kResidualLimit = 0.5;            ///< limits for kUnrelated

/// Replaces the yaw of a step and rotates its translation by half of the yaw change (midpoint rule).
Pose2 with_yaw(const Pose2& step, double turn_rad) {
  const Eigen::Vector2d move = Eigen::Rotation2Dd(0.5 * (turn_rad - step.yaw)) * step.position();
  return {move.x(), move.y(), wrap_angle(turn_rad)};
}

}  // namespace

void GyroOdometry::add(Time stamp, double yaw_rate_radps) {
  if (!headings_.empty() && stamp <= headings_.back().stamp) return;
  double yaw_rad = headings_.empty() ? 0.0 : headings_.back().yaw_rad;
  if (!headings_.empty()) {
    const Time gap = stamp - headings_.back().stamp;
    if (gap > kMaxGyroGap) headings_.clear();
    else yaw_rad += 0.5 * (last_rate_radps_ + yaw_rate_radps) * to_seconds(gap);
  }
  last_rate_radps_ = yaw_rate_radps;
  headings_.push_back({stamp, yaw_rad});
  while (headings_.size() > kMaxHeadings || stamp - headings_.front().stamp > kBufferLength) headings_.pop_front();
}

std::optional<double> GyroOdometry::heading_at(Time stamp) const {
  const auto after = std::lower_bound(headings_.begin(), headings_.end(), stamp,
                                      [](const Heading& heading, Time t) { return heading.stamp < t; });
  if (after == headings_.end()) return std::nullopt;
  if (after->stamp == stamp) return after->yaw_rad;
  if (after == headings_.begin()) return std::nullopt;
  const Heading& before = *(after - 1);
  return before.yaw_rad +
         to_seconds(stamp - before.stamp) / to_seconds(after->stamp - before.stamp) * (after->yaw_rad - before.yaw_rad);
}

std::optional<double> GyroOdometry::bias_radps() const {
  return stationary_s_ > 0.0 ? std::optional(stationary_rad_ / stationary_s_) : earlier_bias_radps_;
}

Pose2 GyroOdometry::fuse(Time stamp, const Pose2& T_odom_body) {
  const std::optional<double> heading_rad = heading_at(stamp);
  if (!last_stamp_) {
    T_fused_last_ = T_odom_body;
  } else {
    const Pose2 step = T_odom_last_.inverse() * T_odom_body;
    const double dt_s = to_seconds(stamp - *last_stamp_);
    const bool is_covered = heading_rad && last_heading_rad_;
    if (!is_covered) uncovered_s_ += dt_s;
    const double turn_rad =
        fused_yaw(step, dt_s, is_covered ? std::optional(*heading_rad - *last_heading_rad_) : std::nullopt);
    T_fused_last_ = T_fused_last_ * with_yaw(step, turn_rad);
  }
  last_stamp_ = stamp;
  last_heading_rad_ = heading_rad;
  T_odom_last_ = T_odom_body;
  return T_fused_last_;
}

Pose2 GyroOdometry::replace_rotation(const Pose2& motion, Time begin, Time end) const {
  const std::optional<double> begin_rad = heading_at(begin), end_rad = heading_at(end);
  return begin_rad && end_rad
             ? with_yaw(motion, *end_rad - *begin_rad - bias_radps().value_or(0.0) * to_seconds(end - begin))
             : motion;
}

double GyroOdometry::fused_yaw(const Pose2& step, double dt_s, std::optional<double> gyro_rad) {
  if (!gyro_rad || dt_s <= 0.0) return step.yaw;
  compare(step.yaw, *gyro_rad, dt_s);
  const bool is_stationary = step.position().norm() < kStationarySpeed_mps * dt_s &&
                             std::abs(step.yaw) < kStationaryRateRadps * dt_s &&
                             std::abs(*gyro_rad) < kMaxBiasRadps * dt_s;
  if (!is_stationary) {
    standstill_s_ = pending_s_ = pending_rad_ = 0.0;
    if (!bias_radps()) without_bias_s_ += dt_s;
    return *gyro_rad - bias_radps().value_or(0.0) * dt_s;
  }
  standstill_s_ += dt_s;
  pending_s_ += dt_s;
  pending_rad_ += *gyro_rad;
  if (standstill_s_ >= kMinStandstill_s) {
    stationary_s_ += pending_s_;
    stationary_rad_ += pending_rad_;
    pending_s_ = pending_rad_ = 0.0;
  }
  return step.yaw;
}

void GyroOdometry::compare(double odometry_rad, double gyro_rad, double dt_s) {
  gg_ += gyro_rad * gyro_rad;
  gt_ += gyro_rad * dt_s;
  tt_ += dt_s * dt_s;
  og_ += odometry_rad * gyro_rad;
  ot_ += odometry_rad * dt_s;
  oo_ += odometry_rad * odometry_rad;
}

GyroConsistency GyroOdometry::consistency() const {
  if (!(tt_ > 0.0)) return GyroConsistency::kUnknown;
  // Remove the part proportional to time, the bias.
  const double gg = gg_ - gt_ * gt_ / tt_, og = og_ - ot_ * gt_ / tt_, oo = oo_ - ot_ * ot_ / tt_;
  if (gg < kMinSquaredYawRad2) return GyroConsistency::kUnknown;
  const double slope = og / gg, residual = std::sqrt(std::max(0.0, oo - slope * og) / gg);
  if (slope < kSlopeLimit || slope > 1.0 / kSlopeLimit || residual > kResidualLimit) return GyroConsistency::kUnrelated;
  return std::abs(slope - 1.0) < kSlopeTolerance && residual < kResidualTolerance ? GyroConsistency::kAgrees
                                                                                  : GyroConsistency::kContradicts;
}

}  // namespace patrol::io
