#pragma once

#include <array>
#include <cstdint>
#include <functional>

#include <Eigen/Core>

#include "core/random.h"
#include "core/robot_description.h"
#include "core/sensors/registry.h"

namespace patrol::test {

/// A quadruped of the size of models/quadruped, without reading the file.
RobotDescription make_quadruped();

/// The way a trunk goes: velocity of its level frame at a time.
struct PlanarVelocity {
  double vx_mps = 0.0;
  double vy_mps = 0.0;
  double yaw_rate_radps = 0.0;
};
using Walk = std::function<PlanarVelocity(double time_s)>;

/// Stands for `stand_s`, then speeds up within a second to `velocity` and keeps it.
Walk stand_then_walk(double stand_s, const PlanarVelocity& velocity);

struct WalkingRobotSettings {
  double period_s = 0.004;
  double gait_period_s = 0.36;
  double gait_duty = 0.6;
  double height_m = 0.30;
  double roll_wobble_rad = 0.02;
  double pitch_wobble_rad = 0.03;
  double height_wobble_m = 0.004;
  double slope_rad = 0.0;  ///< slope of the trunk, nose down; the ground is flat

  double gyro_noise_radps_per_sqrt_hz = 2e-4;
  double accel_noise_mps2_per_sqrt_hz = 3e-3;
  Eigen::Vector3d gyro_bias_radps{0.003, -0.002, 0.004};
  Eigen::Vector3d accel_bias_mps2{0.03, -0.02, 0.02};
  double joint_noise_rad = 1e-4;
  double joint_speed_noise_radps = 0.02;
  /// Velocity over ground of a foot that should stand, in world.
  std::function<Eigen::Vector3d(int leg, double time_s)> slip = nullptr;

  static WalkingRobotSettings without_noise();
};

/// A trotting quadruped by kinematics alone, for tests of odometry: the trunk follows a given walk with the
/// wobble of a trot, standing feet roll on the ground without slipping, joint angles follow. No forces; the
/// ground is z = 0.
class WalkingRobot {
 public:
  WalkingRobot(const RobotDescription& robot, Walk walk, const WalkingRobotSettings& settings, std::uint64_t seed);

  /// One sensor period on.
  void step();

  // As measured now.
  Imu imu() const;
  JointState joints() const;
  FootContacts contacts() const;

  // The truth.
  Time now() const;
  const Pose3& T_world_body() const { return T_world_body_; }
  const Eigen::Vector3d& v_world() const { return v_world_; }
  double way_m() const { return way_m_; }

 private:
  struct Leg {
    Eigen::Vector3d angle_rad, speed_radps;
    bool is_standing = true;
    Eigen::Vector3d lift_off, center;  ///< positions of the foot, in world
  };
  void substep();
  void place_trunk();
  Eigen::Vector3d level_velocity_in_world(double time_s, double yaw_rad) const;
  Eigen::Vector3d rolling_speed(const LegGeometry& leg, int index, const Eigen::Vector3d& angle_rad) const;
  bool should_stand(int index, double* swing_fraction) const;
  Eigen::Vector3d swing_center(int index, double fraction) const;

  RobotDescription robot_;
  Walk walk_;
  WalkingRobotSettings settings_;
  RandomStream gyro_noise_, accel_noise_, joint_noise_, speed_noise_, force_noise_;

  std::int64_t tick_ = 0;  ///< sensor periods
  double time_s_ = 0.0;
  double cycle_ = 0.0;  ///< number of gait cycles; 0 while the robot is stationary
  double yaw_rad_ = 0.0;
  Eigen::Vector2d position_m_ = Eigen::Vector2d::Zero();
  double way_m_ = 0.0;
  Pose3 T_world_body_;
  Eigen::Vector3d v_world_ = Eigen::Vector3d::Zero();
  Eigen::Vector3d a_world_ = Eigen::Vector3d::Zero();
  Eigen::Vector3d omega_body_ = Eigen::Vector3d::Zero();
  std::array<Leg, 4> legs_;
};

}  // namespace patrol::test
