#include "sim/locomotion/fall_detector.h"

#include <cmath>

#include <Eigen/Geometry>

#include "core/geometry/angles.h"

namespace patrol::sim {
namespace {

constexpr double kLevelingRate_per_s = 0.5;  // rate of the accelerometer correction of the attitude
constexpr double kLevelSettling_s = 0.5;     // time after switch-on with the accelerometer only
const double kFallenCosine = std::cos(to_rad(60.0));

}  // namespace

void FallDetector::step(const Imu& imu) {
  age_s_ += tick_s_;
  const Eigen::Vector3d rate = R_body_imu_ * imu.angular_velocity_radps;
  const Eigen::Vector3d force = R_body_imu_ * imu.linear_acceleration_mps2;
  up_in_body_ += tick_s_ * up_in_body_.cross(rate);
  const double gain = age_s_ < kLevelSettling_s ? 10.0 : kLevelingRate_per_s;
  if (force.norm() > 1.0) up_in_body_ += gain * tick_s_ * (force.normalized() - up_in_body_);
  up_in_body_.normalize();
  fallen_s_ = up_in_body_.z() < kFallenCosine ? fallen_s_ + tick_s_ : 0.0;
}

}  // namespace patrol::sim
