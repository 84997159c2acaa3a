#pragma once

#include <Eigen/Core>

#include "core/geometry/zeros.h"
#include "core/robot_description.h"
#include "core/sensors/registry.h"
#include "sim/locomotion/force_distribution.h"

namespace patrol::sim {

/// Firmware's estimate of the trunk and the feet at one tick. `level` is the trunk frame without roll and pitch.
struct TrunkState {
  Eigen::Matrix3d R_level_body = Eigen::Matrix3d::Identity();
  double roll_rad = 0.0;
  double pitch_rad = 0.0;
  double yaw_rad = 0.0;                                    ///< yaw since switch-on, drifting with the gyro
  Eigen::Vector3d rate_radps = Eigen::Vector3d::Zero();    ///< angular rate, in level
  Eigen::Vector3d velocity_mps = Eigen::Vector3d::Zero();  ///< velocity, in level
  /// Center of each foot relative to the trunk's origin, and its velocity relative to the trunk, in level.
  FootVectors foot_m = zeros<FootVectors>(), foot_velocity_mps = zeros<FootVectors>();
  FootMatrices jacobian = zeros<FootMatrices>();  ///< derivative of foot_m with respect to the joints, in level
  FootFlags is_touching{};
};

/// State estimator of the firmware, from joint encoders, IMU and foot sensors: a complementary filter for roll and
/// pitch, and a velocity from the accelerometer corrected by the stance feet. The stack's odometry (localize/) is
/// separate and more accurate; the firmware needs its estimate within a tick.
class TrunkEstimator {
 public:
  /// `touch_force_n` is the foot force above which a foot touches the ground, `velocity_time_s` the time constant of
  /// the stance feet in the velocity.
  TrunkEstimator(RobotDescription robot, double touch_force_n, double velocity_time_s, double tick_s);

  const TrunkState& update(const Imu& reading, const JointState& joints, const FootContacts& contacts);
  const TrunkState& state() const { return state_; }

  template <typename Archive>
  void serialize_state(Archive& archive) {
    archive(age_s_, up_in_body_, foot_roll_mps_, state_);
  }

 private:
  void update_attitude(const Imu& imu);
  void update_feet(const Imu& imu, const JointState& joints, const FootContacts& contacts);
  void update_velocity(const Imu& imu);

  RobotDescription robot_;
  Eigen::Matrix3d R_body_imu_ = Eigen::Matrix3d::Identity();
  double touch_force_n_;
  double velocity_time_s_;
  double tick_s_;
  double age_s_ = 0.0;  ///< time since switch-on
  Eigen::Vector3d up_in_body_ = Eigen::Vector3d::UnitZ();
  /// Velocity of a foot's center as it rolls over its contact, in level.
  FootVectors foot_roll_mps_ = zeros<FootVectors>();
  TrunkState state_;
};

}  // namespace patrol::sim
