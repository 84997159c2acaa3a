#include "odometry.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/geometry/angles.h"

namespace mrpt_stack {
namespace {

constexpr double kMaxRest_m = 2e-4;  // motion of a wheel at rest: a few counts of its encoder
constexpr int kSettlingReadings = 100;
constexpr Time kHistory = std::chrono::milliseconds(500);

}  // namespace

Odometry::Odometry(const patrol::RobotDescription& robot, double ticks_per_turn) : robot_(robot) {
  if (robot.tracks) meters_per_tick_ = 2.0 * std::numbers::pi * robot.tracks->sprocket_radius_m / ticks_per_turn;
}

void Odometry::advance(double distance_m, double dt_s) {
  T_odom_body_.x += distance_m * std::cos(T_odom_body_.yaw);
  T_odom_body_.y += distance_m * std::sin(T_odom_body_.yaw);
  distance_m_ += std::abs(distance_m);
  speed_mps_ = distance_m / dt_s;
}

void Odometry::add(const patrol::TrackTicks& ticks) {
  if (last_ticks_ && ticks.stamp > last_ticks_->stamp) {
    const double counts =
        0.5 * static_cast<double>((ticks.left - last_ticks_->left) + (ticks.right - last_ticks_->right));
    advance(meters_per_tick_ * counts, patrol::to_seconds(ticks.stamp - last_ticks_->stamp));
    is_at_rest_ = speed_mps_ == 0.0;
    if (ticks.left != last_ticks_->left || ticks.right != last_ticks_->right) num_at_rest_ = 0;
  }
  last_ticks_ = ticks;
}

void Odometry::add(const patrol::JointState& joints) {
  if (last_joints_ && joints.stamp > last_joints_->stamp) {
    const double dt_s = patrol::to_seconds(joints.stamp - last_joints_->stamp);
    double sum_m = 0.0, since_rest_m = 0.0;
    int num_wheels = 0;
    for (const patrol::WheelGeometry& wheel : robot_.wheels) {
      if (!wheel.drive_joint) continue;
      const std::size_t joint = *wheel.drive_joint;
      const auto distance_m = [&](const patrol::JointState& from) {
        return wheel.forward_sign * wheel.radius_m *
               patrol::wrap_angle(joints.position_rad[joint] - from.position_rad[joint]);
      };
      sum_m += distance_m(*last_joints_);
      since_rest_m = std::max(since_rest_m, std::abs(distance_m(*rest_joints_)));
      ++num_wheels;
    }
    advance(sum_m / num_wheels, dt_s);
    is_at_rest_ = since_rest_m < kMaxRest_m;
    if (!is_at_rest_) {
      num_at_rest_ = 0;
      rest_joints_ = joints;
    }
  } else if (!last_joints_) {
    rest_joints_ = joints;
  }
  last_joints_ = joints;
}

void Odometry::add(const patrol::Imu& imu) {
  const double rate_radps = imu.angular_velocity_radps.z();
  // The bias is the mean while the robot stands still, and not just after it stopped.
  if (is_at_rest_ && ++num_at_rest_ > kSettlingReadings) {
    // Tracks begin a new mean at each stop, wheels continue the last one: their stops are short.
    num_in_mean_ = robot_.tracks ? num_at_rest_ - kSettlingReadings : num_in_mean_ + 1;
    gyro_bias_radps_ += (rate_radps - gyro_bias_radps_) / std::min(num_in_mean_, robot_.tracks ? 400 : 4000);
  }
  yaw_rate_radps_ = rate_radps - gyro_bias_radps_;
  if (last_imu_) T_odom_body_.yaw += yaw_rate_radps_ * patrol::to_seconds(imu.stamp - *last_imu_);
  last_imu_ = imu.stamp;
  history_.emplace_back(imu.stamp, T_odom_body_);
  while (history_.front().first < imu.stamp - kHistory) history_.pop_front();
}

Pose2 Odometry::pose_at(Time stamp) const {
  const auto after = std::ranges::lower_bound(history_, stamp, {}, &std::pair<Time, Pose2>::first);
  if (after == history_.end()) return T_odom_body_;
  if (after == history_.begin()) return after->second;
  const auto& [begin, from] = *(after - 1);
  const auto& [end, to] = *after;
  const double ratio = patrol::to_seconds(stamp - begin) / patrol::to_seconds(end - begin);
  return {from.x + ratio * (to.x - from.x), from.y + ratio * (to.y - from.y), from.yaw + ratio * (to.yaw - from.yaw)};
}

}  // namespace mrpt_stack
