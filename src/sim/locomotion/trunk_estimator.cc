#include "sim/locomotion/trunk_estimator.h"

#include <cmath>
#include <utility>

#include <Eigen/Geometry>

#include "core/gravity.h"
#include "core/leg_kinematics.h"

namespace patrol::sim {
namespace {

constexpr double kAttitudeTime_s = 2.0;  // time constant of the accelerometer in roll and pitch
constexpr double kSettlingTime_s = 0.1;  // time constant of the accelerometer in the first second, before the
                                         // estimate has converged
constexpr double kSettling_s = 1.0;

}  // namespace

TrunkEstimator::TrunkEstimator(RobotDescription robot, double touch_force_n, double velocity_time_s, double tick_s)
    : robot_(std::move(robot)), touch_force_n_(touch_force_n), velocity_time_s_(velocity_time_s), tick_s_(tick_s) {
  if (const auto imu = robot_.T_body_sensor.find("imu"); imu != robot_.T_body_sensor.end())
    R_body_imu_ = imu->second.rotation.toRotationMatrix();
  state_.foot_m.fill(Eigen::Vector3d::Zero());
  state_.foot_velocity_mps.fill(Eigen::Vector3d::Zero());
  foot_roll_mps_.fill(Eigen::Vector3d::Zero());
}

const TrunkState& TrunkEstimator::update(const Imu& reading, const JointState& joints, const FootContacts& contacts) {
  Imu imu = reading;  // in body
  imu.angular_velocity_radps = R_body_imu_ * reading.angular_velocity_radps;
  imu.linear_acceleration_mps2 = R_body_imu_ * reading.linear_acceleration_mps2;
  update_attitude(imu);
  update_feet(imu, joints, contacts);
  update_velocity(imu);
  age_s_ += tick_s_;
  return state_;
}

// Propagates the "up" direction in the body with the gyro. Corrects it by the accelerometer, without the centripetal
// part, while that measures about one g.
void TrunkEstimator::update_attitude(const Imu& imu) {
  const Eigen::Vector3d& omega = imu.angular_velocity_radps;
  const Eigen::Vector3d centripetal = state_.rate_radps.z() * Eigen::Vector3d::UnitZ().cross(state_.velocity_mps);
  const Eigen::Vector3d force = imu.linear_acceleration_mps2 - state_.R_level_body.transpose() * centripetal;
  const double size = force.norm();
  up_in_body_ += tick_s_ * up_in_body_.cross(omega);
  if (std::abs(size - kGravity_mps2) < 0.5 * kGravity_mps2) {
    const double time_s = age_s_ < kSettling_s ? kSettlingTime_s : kAttitudeTime_s;
    up_in_body_ += (tick_s_ / time_s) * (force / size - up_in_body_);
  }
  up_in_body_.normalize();
  state_.roll_rad = std::atan2(up_in_body_.y(), up_in_body_.z());
  state_.pitch_rad = std::atan2(-up_in_body_.x(), std::hypot(up_in_body_.y(), up_in_body_.z()));
  state_.R_level_body = (Eigen::AngleAxisd(state_.pitch_rad, Eigen::Vector3d::UnitY()) *
                         Eigen::AngleAxisd(state_.roll_rad, Eigen::Vector3d::UnitX()))
                            .toRotationMatrix();
  state_.rate_radps = state_.R_level_body * omega;
  state_.yaw_rad += tick_s_ * state_.rate_radps.z();
}

void TrunkEstimator::update_feet(const Imu& imu, const JointState& joints, const FootContacts& contacts) {
  for (int leg = 0; leg < kNumLegs; ++leg) {
    const auto joint = static_cast<std::size_t>(3 * leg);
    const Eigen::Vector3d angle(joints.position_rad[joint], joints.position_rad[joint + 1],
                                joints.position_rad[joint + 2]);
    const Eigen::Vector3d speed(joints.velocity_radps[joint], joints.velocity_radps[joint + 1],
                                joints.velocity_radps[joint + 2]);
    const LegGeometry& geometry = robot_.legs[static_cast<std::size_t>(leg)];
    state_.foot_m[leg] = state_.R_level_body * foot_position(geometry, angle);
    state_.jacobian[leg] = state_.R_level_body * foot_jacobian(geometry, angle);
    state_.foot_velocity_mps[leg] = state_.jacobian[leg] * speed + state_.rate_radps.cross(state_.foot_m[leg]);
    state_.is_touching[leg] = contacts.force_n[static_cast<std::size_t>(leg)] > touch_force_n_;
    // The round foot rolls on the ground with the trunk and the shank.
    const Eigen::Vector3d foot_rate =
        state_.R_level_body * (imu.angular_velocity_radps + shank_rate(geometry, angle, speed));
    foot_roll_mps_[leg] = foot_rate.cross(geometry.foot_radius_m * Eigen::Vector3d::UnitZ());
  }
}

void TrunkEstimator::update_velocity(const Imu& imu) {
  Eigen::Vector3d& velocity = state_.velocity_mps;
  const Eigen::Vector3d acceleration =
      state_.R_level_body * imu.linear_acceleration_mps2 - kGravity_mps2 * Eigen::Vector3d::UnitZ();
  velocity += tick_s_ * (acceleration - state_.rate_radps.z() * Eigen::Vector3d::UnitZ().cross(velocity));
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  int count = 0;
  for (int leg = 0; leg < kNumLegs; ++leg) {
    if (!state_.is_touching[leg]) continue;
    sum += foot_roll_mps_[leg] - state_.foot_velocity_mps[leg];
    ++count;
  }
  if (count > 0) velocity += (tick_s_ / velocity_time_s_) * (sum / count - velocity);
}

}  // namespace patrol::sim
