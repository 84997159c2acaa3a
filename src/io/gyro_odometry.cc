#include "io/gyro_odometry.h"

#include <algorithm>
#include <cmath>

namespace patrol::io {
namespace {

constexpr Time kLongestGap = std::chrono::milliseconds(500);  ///< maximum time between gyro messages
constexpr Time kMemory = std::chrono::seconds(300);  ///< buffer length; must exceed the delay of scans behind the gyro
constexpr std::size_t kMostHeadings = 300'000;
constexpr double kStandingSpeed_mps = 0.005, kStandingRateRadps = 0.005;  ///< standstill thresholds of the odometry
constexpr double kMostBiasRadps = 0.05;       ///< maximum gyro rate of a standstill, whatever the wheels report
constexpr double kShortestStandstill_s = 1.0;
/// Minimum sum of squared yaw increments for a verdict: three rad at 1 deg per step.
constexpr double kEnoughTurnsRad2 = 0.05;
constexpr double kSlopeTol = 0.02, kResidualTol = 0.05;  ///< limits for kAgrees
constexpr double kSlopeLimit = 0.5, kResidualLimit = 0.5;  ///< limits for kUnrelated

/// Replaces the yaw of a step and rotates its translation by half of the yaw change (midpoint rule).
Pose2 with_turn(const Pose2& step, double turn_rad) {
  const Eigen::Vector2d move = Eigen::Rotation2Dd(0.5 * (turn_rad - step.yaw)) * step.position();
  return {move.x(), move.y(), wrap_angle(turn_rad)};
}

}  // namespace

void GyroOdometry::add(Time stamp, double yaw_rate_radps) {
  if (!headings_.empty() && stamp <= headings_.back().stamp) return;
  double yaw_rad = headings_.empty() ? 0.0 : headings_.back().yaw_rad;
  if (!headings_.empty()) {
    const Time gap = stamp - headings_.back().stamp;
    if (gap > kLongestGap) headings_.clear();
    else yaw_rad += 0.5 * (last_rate_radps_ + yaw_rate_radps) * to_seconds(gap);
  }
  last_rate_radps_ = yaw_rate_radps;
  headings_.push_back({stamp, yaw_rad});
  while (headings_.size() > kMostHeadings || stamp - headings_.front().stamp > kMemory) headings_.pop_front();
}

std::optional<double> GyroOdometry::heading_at(Time stamp) const {
  const auto after = std::lower_bound(headings_.begin(), headings_.end(), stamp, [](const Heading& heading, Time t) { return heading.stamp < t; });
  if (after == headings_.end()) return std::nullopt;
  if (after->stamp == stamp) return after->yaw_rad;
  if (after == headings_.begin()) return std::nullopt;
  const Heading& before = *(after - 1);
  return before.yaw_rad + to_seconds(stamp - before.stamp) / to_seconds(after->stamp - before.stamp) * (after->yaw_rad - before.yaw_rad);
}

std::optional<double> GyroOdometry::bias_radps() const {
  return standing_s_ > 0.0 ? std::optional(standing_rad_ / standing_s_) : earlier_bias_radps_;
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
    const double turn_rad = turn_of_step(step, dt_s, is_covered ? std::optional(*heading_rad - *last_heading_rad_) : std::nullopt);
    T_fused_last_ = T_fused_last_ * with_turn(step, turn_rad);
  }
  last_stamp_ = stamp;
  last_heading_rad_ = heading_rad;
  T_odom_last_ = T_odom_body;
  return T_fused_last_;
}

Pose2 GyroOdometry::turned(const Pose2& motion, Time begin, Time end) const {
  const std::optional<double> begin_rad = heading_at(begin), end_rad = heading_at(end);
  return begin_rad && end_rad ? with_turn(motion, *end_rad - *begin_rad - bias_radps().value_or(0.0) * to_seconds(end - begin)) : motion;
}

double GyroOdometry::turn_of_step(const Pose2& step, double dt_s, std::optional<double> gyro_rad) {
  if (!gyro_rad || dt_s <= 0.0) return step.yaw;
  compare(step.yaw, *gyro_rad, dt_s);
  const bool stands = step.position().norm() < kStandingSpeed_mps * dt_s && std::abs(step.yaw) < kStandingRateRadps * dt_s && std::abs(*gyro_rad) < kMostBiasRadps * dt_s;
  if (!stands) {
    standstill_s_ = pending_s_ = pending_rad_ = 0.0;
    if (!bias_radps()) without_bias_s_ += dt_s;
    return *gyro_rad - bias_radps().value_or(0.0) * dt_s;
  }
  standstill_s_ += dt_s;
  pending_s_ += dt_s;
  pending_rad_ += *gyro_rad;
  if (standstill_s_ >= kShortestStandstill_s) {
    standing_s_ += pending_s_;
    standing_rad_ += pending_rad_;
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

GyroVerdict GyroOdometry::verdict() const {
  if (!(tt_ > 0.0)) return GyroVerdict::kUnknown;
  // Remove the part proportional to time, the bias.
  const double gg = gg_ - gt_ * gt_ / tt_, og = og_ - ot_ * gt_ / tt_, oo = oo_ - ot_ * ot_ / tt_;
  if (gg < kEnoughTurnsRad2) return GyroVerdict::kUnknown;
  const double slope = og / gg, residual = std::sqrt(std::max(0.0, oo - slope * og) / gg);
  if (slope < kSlopeLimit || slope > 1.0 / kSlopeLimit || residual > kResidualLimit) return GyroVerdict::kUnrelated;
  return std::abs(slope - 1.0) < kSlopeTol && residual < kResidualTol ? GyroVerdict::kAgrees : GyroVerdict::kContradicts;
}

}  // namespace patrol::io
