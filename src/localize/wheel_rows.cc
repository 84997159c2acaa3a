#include "localize/wheel_rows.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include <fmt/format.h>

#include "core/error.h"
#include "core/wheel_kinematics.h"

namespace patrol::localize {
namespace {

/// Difference between the rim speeds of the wheels of a side above which one of them has no traction. On level ground,
/// skid steering with scrubbing wheels has up to 0.14 m/s (substation patrol, seed 1).
constexpr double kTractionLoss_mps = 0.15;
/// Time constant of the speeds, as for the speeds of TrackEncoders.
constexpr double kRimSmoothing_s = 0.1;
/// Speeds over a longer interval are meaningless.
constexpr double kMaxRimInterval_s = 0.5;
/// A faster rim is a restart of the encoders.
constexpr double kMaxRim_mps = 10.0;
/// Age of a gyro reading above which it is not used.
constexpr double kMaxGyroAge_s = 0.1;

double blend(double step_s) { return std::min(1.0, step_s / kRimSmoothing_s); }

/// Indices of the wheels that may represent a side; empty: all of them have traction.
std::vector<std::size_t> candidates(const std::vector<double>& speed_mps) {
  std::vector<std::size_t> wheels;
  if (speed_mps.empty()) return wheels;
  const auto [slowest, fastest] = std::ranges::minmax(speed_mps);
  if (fastest - slowest <= kTractionLoss_mps) return wheels;
  for (std::size_t wheel = 0; wheel < speed_mps.size(); ++wheel) wheels.push_back(wheel);
  return wheels;
}

double mean(const std::vector<double>& values) {
  double sum = 0.0;
  for (const double value : values) sum += value;
  return sum / static_cast<double>(values.size());
}

}  // namespace

WheelRows::WheelRows(const RobotDescription& robot, double ticks_per_turn)
    : ticks_per_rad_(ticks_per_turn / (2.0 * std::numbers::pi)),
      radius_m_(differential_geometry(robot).rolling_radius_m),
      gauge_m_(differential_geometry(robot).gauge_m),
      up_in_imu_(robot.T_body("imu").rotation.toRotationMatrix().row(2)) {
  for (const WheelGeometry& wheel : robot.wheels) {
    if (wheel.drive_joint && !wheel.steering_joint)
      (wheel.is_left() ? left_ : right_).joints.emplace_back(*wheel.drive_joint, wheel.forward_sign);
  }
  if (left_.joints.empty() || right_.joints.empty()) {
    throw InputError(
        fmt::format("stack.odometry_source = wheeled: robot {} has no driven wheels on both sides that are not steered",
                    robot.name));
  }
}

void WheelRows::add(const Imu& imu) {
  const double yaw_rate_radps = up_in_imu_ * imu.angular_velocity_radps;
  if (!std::isfinite(yaw_rate_radps) || (gyro_stamp_ && imu.stamp <= *gyro_stamp_)) return;
  const double step_s = gyro_stamp_ ? to_seconds(imu.stamp - *gyro_stamp_) : kRimSmoothing_s;
  yaw_rate_radps_ += blend(step_s) * (yaw_rate_radps - yaw_rate_radps_);
  gyro_stamp_ = imu.stamp;
}

TrackTicks WheelRows::add(const JointState& joints) {
  if (!stamp_ || joints.stamp > *stamp_) {
    const double step_s = stamp_ ? to_seconds(joints.stamp - *stamp_) : kMaxRimInterval_s;
    update(left_, joints, step_s);
    update(right_, joints, step_s);
    stamp_ = joints.stamp;
    if (gyro_stamp_ && std::abs(to_seconds(joints.stamp - *gyro_stamp_)) <= kMaxGyroAge_s) use_wheels_with_traction();
  }
  return {.stamp = joints.stamp, .left = ticks(left_), .right = ticks(right_)};
}

// After a restart or a gap, the speeds begin anew.
void WheelRows::update(Side& side, const JointState& joints, double step_s) const {
  const std::vector<double> before = side.angle_rad;
  side.angle_rad.clear();
  for (const auto& [joint, sign] : side.joints) side.angle_rad.push_back(sign * joints.position_rad[joint]);
  side.step_rad.assign(side.joints.size(), 0.0);
  bool is_valid = !before.empty() && step_s <= kMaxRimInterval_s;
  for (std::size_t wheel = 0; wheel < before.size(); ++wheel) {
    side.step_rad[wheel] = side.angle_rad[wheel] - before[wheel];
    is_valid = is_valid && std::abs(side.step_rad[wheel]) * radius_m_ <= kMaxRim_mps * step_s;
  }
  if (!is_valid) return side.speed_mps.clear();
  const bool is_first = side.speed_mps.empty();
  side.speed_mps.resize(side.joints.size());
  for (std::size_t wheel = 0; wheel < side.joints.size(); ++wheel) {
    double& smooth_mps = side.speed_mps[wheel];
    const double speed_mps = side.step_rad[wheel] * radius_m_ / step_s;
    smooth_mps = is_first ? speed_mps : smooth_mps + blend(step_s) * (speed_mps - smooth_mps);
  }
}

// With one lifted wheel, skid steering scrubs little: the geometric gauge suffices to tell the wheels apart.
void WheelRows::use_wheels_with_traction() {
  if (left_.speed_mps.empty() || right_.speed_mps.empty()) return;
  std::vector<std::size_t> left = candidates(left_.speed_mps), right = candidates(right_.speed_mps);
  if (left.empty() && right.empty()) return;
  constexpr std::size_t kAll = std::numeric_limits<std::size_t>::max();
  if (left.empty()) left = {kAll};
  if (right.empty()) right = {kAll};
  const auto speed_mps = [](const Side& side, std::size_t wheel) {
    return wheel == kAll ? mean(side.speed_mps) : side.speed_mps[wheel];
  };
  std::size_t best_left = kAll, best_right = kAll;
  double min_misfit_mps = std::numeric_limits<double>::infinity();
  for (const std::size_t l : left) {
    for (const std::size_t r : right) {
      const double misfit_mps = std::abs(speed_mps(right_, r) - speed_mps(left_, l) - yaw_rate_radps_ * gauge_m_);
      if (misfit_mps >= min_misfit_mps) continue;
      min_misfit_mps = misfit_mps;
      best_left = l, best_right = r;
    }
  }
  if (best_left != kAll) left_.offset_rad += left_.step_rad[best_left] - mean(left_.step_rad);
  if (best_right != kAll) right_.offset_rad += right_.step_rad[best_right] - mean(right_.step_rad);
}

std::int64_t WheelRows::ticks(const Side& side) const {
  return std::llround((mean(side.angle_rad) + side.offset_rad) * ticks_per_rad_);
}

}  // namespace patrol::localize
