#pragma once

#include <cstdint>
#include <functional>

#include <Eigen/Core>

#include "core/random.h"
#include "core/robot_description.h"
#include "core/sensors/registry.h"

namespace patrol::test {

/// A tracked robot of the size of models/tracked, without reading the file.
RobotDescription make_tracked_robot();

/// Belt speeds asked for.
struct Belts {
  double left_mps = 0.0;
  double right_mps = 0.0;
};
/// Command of an operator at a time; may depend on the pose of the body.
using BeltProgram = std::function<Belts(double time_s, const Pose3& T_world_body)>;

/// Straight stretches, curves and turns on the spot, about 0.4 m/s on average, with halts; the first 3 s it stands.
BeltProgram make_tour();
/// Stands 3 s, then keeps the belts at these speeds.
BeltProgram stand_then_drive(const Belts& belts);
/// Stands 3 s, then follows the line y = 1.5 m sin(2 pi x / 60 m) to +x at 0.5 m/s, by sight.
BeltProgram stand_then_weave();

/// What is wrong with the world. Every figure is a standard deviation unless it says otherwise; the constants are drawn
/// once.
struct TrackedDriveSettings {
  double imu_period_s = 0.004;
  double tick_period_s = 0.02;
  double max_belt_acceleration_mps2 = 1.0;
  double ticks_per_sprocket_turn = 720.0;
  // Ground.
  double scale = 0.01;           ///< scale error of both tracks, constant
  double slip = 0.02;            ///< slip of each track, fraction of its distance; wanders
  double slip_per_radps = 0.07;  ///< additional slip in turns, per rad/s
  double slip_per_tilt = 0.14;   ///< additional slip on slopes, per sine of the tilt
  double slip_length_m = 3.0;
  double crab = 0.005;      ///< sideways, share of the way; wanders over the same length
  double turn_ratio = 1.5;  ///< mean: distance of the tracks' centers of rotation over the gauge
  double turn_ratio_std = 0.15;
  double icr_x_m = 0.05;
  double icr_y_m = 0.02;
  double turn_length_rad = 2.0;
  double pitch_rad = 0.03;  ///< amplitude of the ground's waves
  double roll_rad = 0.02;
  double vibration_mps2_rthz = 0.03;  ///< noise of the accelerometer while the tracks run at 1 m/s
  std::function<double(double time_s)> friction = nullptr;  ///< coefficient; 0.8 if none
  // IMU: the defaults of sim/sensors/imu.h, sampled every other tick of 2 ms.
  double gyro_noise_radps = 2.3e-4 / 0.0447213595;
  double gyro_bias_radps = 0.002;
  double gyro_bias_random_walk_radps_per_sqrt_s = 1e-5;
  double accel_noise_mps2 = 0.002 / 0.0447213595;
  double accel_bias_mps2 = 0.03;
  double accel_bias_random_walk_mps2_per_sqrt_s = 1e-4;
  double imu_scale = 0.001;
  double imu_misalignment_rad = 0.00087;
  double gyro_resolution_radps = 7e-4;
  double accel_resolution_mps2 = 0.0082;

  static TrackedDriveSettings without_noise();
  /// Robot whose parameters are not those that the filters assume.
  ///
  /// IMU by the ADIS16448 data sheet: rate noise density 0.0135 deg/s/sqrt(Hz), initial bias 0.5 deg/s (1 sigma),
  /// acceleration noise density 0.23 mg/sqrt(Hz), bias repeatability 20 mg (1 sigma), alignment 0.05 to 0.2 deg; but
  /// for its sensitivity of 1 %, for which see `imu_scale`. Ground: no sheet states slip. Half of the assumed slip per
  /// distance on a third of the correlation length, twice the crabbing, one and a half times the wear, a scrub ratio of
  /// 1.41 (five evenly loaded wheels, tests/scenario/tracks_test.cc) instead of 1.5 that varies half as much over half
  /// the rotation, and twice the slope.
  static TrackedDriveSettings of_data_sheets();
};

/// A tracked robot by kinematics alone, for tests of odometry. Each belt slips by a share of its way that wanders; the
/// body turns about the tracks' instantaneous centers of rotation (Mandow et al., IROS 2007):
///   yaw rate = (r - l) / D,  ahead = (l y_l - r y_r) / (y_l - y_r) with y_l - y_r = D,  left = -x yaw rate, and a
///   little crabbing.
/// The ground waves gently under it. Friction below what the belts ask for limits what the body can follow.
class TrackedDrive {
 public:
  TrackedDrive(const RobotDescription& robot, BeltProgram program, const TrackedDriveSettings& settings,
               std::uint64_t seed);

  /// One IMU period on.
  void step();
  bool has_ticks() const { return imu_steps_ % steps_per_ticks_ == 0; }

  // As measured now.
  const Imu& imu() const { return imu_; }
  TrackTicks ticks() const;

  // The truth.
  Time now() const { return Time{imu_steps_ * step_.count()}; }
  const Pose3& T_world_body() const { return T_world_body_; }
  double speed_mps() const { return ahead_mps_; }
  double way_m() const { return way_m_; }
  double gyro_z_bias_radps() const { return gyro_bias_.z(); }

 private:
  /// Wanders with zero mean and a given deviation, forgetting over its length.
  struct Wanderer {
    double value = 0.0;
    void go(double share_of_length, double std, double normal);
  };
  double draw(std::uint64_t index) const { return wander_noise_.normal(static_cast<std::uint64_t>(imu_steps_), index); }
  void run_belts(double dt_s);
  void slip_and_turn(double dt_s);
  void place_body(double dt_s);
  void measure_imu(const Eigen::Vector3d& omega_body, const Eigen::Vector3d& force_body);

  RobotDescription robot_;
  BeltProgram program_;
  TrackedDriveSettings settings_;
  RandomStream constants_, wander_noise_, imu_noise_;
  Time step_;
  std::int64_t steps_per_ticks_;

  std::int64_t imu_steps_ = 0;
  Belts contact_;                                         ///< present speeds of the tracks
  Eigen::Vector2d belt_way_m_ = Eigen::Vector2d::Zero();  ///< left, right
  double scale_;
  Wanderer slip_left_, slip_right_, crab_, turn_ratio_, turn_x_, turn_y_;
  double ahead_mps_ = 0.0, leftward_mps_ = 0.0, yaw_rate_radps_ = 0.0;
  double way_m_ = 0.0;
  double yaw_rad_ = 0.0;
  Eigen::Vector3d p_ground_ = Eigen::Vector3d::Zero();
  Pose3 T_world_body_;
  Eigen::Vector3d v_world_ = Eigen::Vector3d::Zero();  ///< velocity of the IMU in world
  Eigen::Matrix3d gyro_distortion_, accel_distortion_;
  Eigen::Vector3d gyro_bias_, accel_bias_;
  Imu imu_;
};

}  // namespace patrol::test
