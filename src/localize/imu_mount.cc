#include "localize/imu_mount.h"

#include "core/gravity.h"

namespace patrol::localize {
namespace {

constexpr double kMaxRate_radps = 35.0;  // above the measuring range of a MEMS gyro, 2000 deg/s
constexpr double kMaxForce_mps2 = 16.0 * kGravity_mps2 * 1.8;
constexpr Time kMaxStep = std::chrono::milliseconds(50);  // no angular acceleration is computed over a longer gap

}  // namespace

bool is_plausible(const Imu& imu) {
  return imu.angular_velocity_radps.allFinite() && imu.linear_acceleration_mps2.allFinite() &&
         imu.angular_velocity_radps.cwiseAbs().maxCoeff() < kMaxRate_radps &&
         imu.linear_acceleration_mps2.cwiseAbs().maxCoeff() < kMaxForce_mps2;
}

InertialSample ImuMount::to_body(const Imu& imu) {
  const Eigen::Vector3d rate = T_body_imu_.rotation * imu.angular_velocity_radps;
  Eigen::Vector3d force = T_body_imu_.rotation * imu.linear_acceleration_mps2;
  const Eigen::Vector3d& lever = T_body_imu_.position;
  if (last_ && imu.stamp > *last_ && imu.stamp - *last_ < kMaxStep) {
    const Eigen::Vector3d angular_acceleration = (rate - last_rate_radps_) / to_seconds(imu.stamp - *last_);
    force -= angular_acceleration.cross(lever);
  }
  force -= rate.cross(rate.cross(lever));
  last_rate_radps_ = rate;
  last_ = imu.stamp;
  return {rate, force};
}

}  // namespace patrol::localize
