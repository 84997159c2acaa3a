#pragma once

#include <Eigen/Core>

#include "core/robot_description.h"
#include "core/sensors/registry.h"
#include "sim/locomotion/force_distribution.h"

namespace patrol::sim {

/// What the firmware knows of the trunk and the feet at one tick. `level` is the trunk with roll and pitch removed.
struct TrunkState {
  Eigen::Matrix3d R_level_body = Eigen::Matrix3d::Identity();
  double roll_rad = 0.0;
  double pitch_rad = 0.0;
  double yaw_rad = 0.0;                                       ///< since switch-on, drifting with the gyro
  Eigen::Vector3d rate_radps = Eigen::Vector3d::Zero();       ///< in level
  Eigen::Vector3d velocity_mps = Eigen::Vector3d::Zero();     ///< in level
  FootVectors foot_m;                                         ///< centre of each foot from the trunk's origin, in level
  FootVectors foot_velocity_mps;                              ///< relative to the trunk, in level
  std::array<Eigen::Matrix3d, kNumLegs> jacobian;             ///< of foot_m by the joints, in level
  FootFlags is_touching{};
};

/// The firmware's own estimator, from joint encoders, IMU and foot sensors only: a complementary filter for roll and pitch,
/// and for the velocity the accelerometer corrected by the feet that stand. (The stack's odometry, localize/, is another
/// and better one: the firmware needs its answer within a tick.)
class TrunkEstimator {
 public:
  TrunkEstimator(const RobotDescription& robot, double tick_s);

  const TrunkState& update(const Imu& imu, const JointState& joints, const FootContacts& contacts);
  const TrunkState& state() const { return state_; }

 private:
  void update_attitude(const Imu& imu);
  void update_feet(const Imu& imu, const JointState& joints, const FootContacts& contacts);
  void update_velocity(const Imu& imu);

  RobotDescription robot_;
  double tick_s_;
  double age_s_ = 0.0;  ///< since switch-on
  Eigen::Vector3d up_in_body_ = Eigen::Vector3d::UnitZ();
  FootVectors foot_roll_mps_;  ///< velocity of a foot's centre as it rolls over its contact, in level
  TrunkState state_;
};

}  // namespace patrol::sim
