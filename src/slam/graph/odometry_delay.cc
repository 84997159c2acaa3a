#include "slam/graph/odometry_delay.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

#include "slam/rigid_motion.h"

namespace patrol::slam {
namespace {

constexpr double kStep_s = 0.02;
/// Yaw change between two scans from which on they are compared, and largest difference that counts.
constexpr double kMinTurnRad = 0.02, kMaxDifferenceRad = 0.2;
/// Weight of the earlier comparisons per radian of turn.
constexpr double kMemoryPerRad = 0.98;
/// An offset is found after this much turning, if it reduces the differences by this sum and to this fraction.
constexpr double kMinTurnedRad = 10.0, kMinGainRad = 0.5, kMaxRatio = 0.7;

Time offset_of(int step) { return from_seconds(kStep_s * step); }

}  // namespace

Pose2 OdometryDelay::compensated(Time stamp, const Pose2& T_odom_body) {
  const double yaw = readings_.empty() ? T_odom_body.yaw
                                       : readings_.back().odometry_yaw_rad +
                                             wrap_angle(T_odom_body.yaw - readings_.back().T_odom_body.yaw);
  readings_.push_back({.stamp = stamp, .T_odom_body = T_odom_body, .odometry_yaw_rad = yaw});
  if (scan_delay_s_ == 0.0) return T_odom_body;
  return T_continuous_odom_ * odometry_at(stamp - from_seconds(scan_delay_s_)).T_odom_body;
}

void OdometryDelay::update(double yaw_rad) {
  Reading& newest = readings_.back();
  const std::size_t num_before = readings_.size() - 1;
  newest.tracked_yaw_rad = num_before == 0 ? yaw_rad
                                           : readings_[num_before - 1].tracked_yaw_rad +
                                                 wrap_angle(yaw_rad - readings_[num_before - 1].tracked_yaw_rad);
  const Time margin = offset_of(kMaxSteps);
  while (evaluated_ < readings_.size() && readings_[evaluated_].stamp + margin <= newest.stamp) evaluate(evaluated_++);
  choose_offset();
  // The next comparison needs odometry from `margin` before the last compared reading on.
  if (evaluated_ == 0) return;
  const Time needed = readings_[evaluated_ - 1].stamp - margin;
  std::size_t num_old = 0;
  while (num_old + 2 < evaluated_ && readings_[num_old + 1].stamp <= needed) ++num_old;
  readings_.erase(readings_.begin(), readings_.begin() + static_cast<std::ptrdiff_t>(num_old));
  evaluated_ -= num_old;
}

OdometryDelay::Reading OdometryDelay::odometry_at(Time stamp) const {
  const auto after = std::upper_bound(readings_.begin(), readings_.end(), stamp,
                                      [](Time value, const Reading& reading) { return value < reading.stamp; });
  if (after == readings_.begin()) return readings_.front();
  if (after == readings_.end()) return readings_.back();
  const Reading& before = *(after - 1);
  const double fraction = to_seconds(stamp - before.stamp) / to_seconds(after->stamp - before.stamp);
  return {.stamp = stamp,
          .T_odom_body =
              before.T_odom_body * scaled_motion(before.T_odom_body.inverse() * after->T_odom_body, fraction),
          .odometry_yaw_rad = before.odometry_yaw_rad + fraction * (after->odometry_yaw_rad - before.odometry_yaw_rad)};
}

void OdometryDelay::evaluate(std::size_t reading) {
  if (reading == 0) return;
  const Reading &before = readings_[reading - 1], &now = readings_[reading];
  const double tracked = now.tracked_yaw_rad - before.tracked_yaw_rad,
               odometry = now.odometry_yaw_rad - before.odometry_yaw_rad,
               turned = std::max(std::abs(tracked), std::abs(odometry));
  if (turned < kMinTurnRad || before.stamp - offset_of(kMaxSteps) < readings_.front().stamp) return;
  const double memory = std::pow(kMemoryPerRad, turned);
  turned_rad_ = memory * turned_rad_ + turned;
  for (int step = -kMaxSteps; step <= kMaxSteps; ++step) {
    const double then = odometry_at(now.stamp - offset_of(step)).odometry_yaw_rad -
                        odometry_at(before.stamp - offset_of(step)).odometry_yaw_rad;
    double& sum = differences_[static_cast<std::size_t>(step + kMaxSteps)];
    sum = memory * sum + std::min(kMaxDifferenceRad, std::abs(tracked - then));
  }
}

void OdometryDelay::choose_offset() {
  const auto min_difference = std::min_element(differences_.begin(), differences_.end());
  const int step = static_cast<int>(min_difference - differences_.begin()) - kMaxSteps;
  const double none = differences_[kMaxSteps], opposite = differences_[static_cast<std::size_t>(kMaxSteps - step)];
  if (step <= 0 || turned_rad_ < kMinTurnedRad || none - *min_difference < kMinGainRad ||
      *min_difference > kMaxRatio * none || opposite < none)
    return;
  const double found_s = kStep_s * step;
  if (found_s == scan_delay_s_) return;
  const Time stamp = readings_.back().stamp;
  const Pose2 T_continuous_body = T_continuous_odom_ * odometry_at(stamp - from_seconds(scan_delay_s_)).T_odom_body;
  scan_delay_s_ = found_s;
  T_continuous_odom_ = T_continuous_body * odometry_at(stamp - from_seconds(scan_delay_s_)).T_odom_body.inverse();
}

}  // namespace patrol::slam
