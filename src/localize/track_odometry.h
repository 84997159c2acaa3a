#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "core/calibration/calibration_estimate.h"
#include "core/messages.h"
#include "core/robot_description.h"
#include "core/sensors/registry.h"
#include "core/wheel_kinematics.h"
#include "localize/imu_front_end.h"
#include "localize/pending_readings.h"
#include "localize/rest_detector.h"
#include "localize/slip_detector.h"
#include "localize/track_encoders.h"
#include "localize/track_filter.h"
#include "localize/track_odometry_settings.h"

namespace patrol::localize {

/// Health of the tracked odometry, for the log and for the sensor monitor.
struct TrackOdometryHealth {
  bool imu_timed_out = false;       ///< the estimate is propagated by the tracks alone
  bool encoders_timed_out = false;  ///< the estimate is propagated by the IMU alone: no encoder reading was accepted
  bool is_slipping = false;         ///< track and body speeds disagree, or the encoders are frozen: IMU alone
  double gyro_z_bias_std_radps = 0.0;
  std::uint64_t num_rejected_messages = 0;  ///< messages not finite, frozen, implausible, or outdated
  std::uint64_t num_slip_events = 0;
};

/// Tracked odometry: pose of the body in `odom` from track encoders and IMU (track_filter.h), at the newest reading.
/// Also for wheels that are not steered: the wheels of a side are then one track. Mecanum wheels also measure the
/// lateral speed; their speeds that contradict each other increase the standard deviation. The origin of odom is the
/// gravity-aligned pose after the first standstill.
///
/// Messages may be late or missing. Encoder readings wait for the IMU reading of their stamp, at most `imu_timeout_s`;
/// then the tracks alone propagate the estimate. They are compared with the motion history at the middle of their
/// interval. When tracks and body agree again after a loss of traction, the drift of the IMU is corrected, so that odom
/// shifts once by decimeters. Not handled: a robot that is carried, and a loss of traction with an acceleration below
/// `slip_disagreement_mps` in `slip_window_s`.
class TrackOdometry {
 public:
  /// Throws InputError for a robot without tracks and wheels, or without a frame `imu`.
  TrackOdometry(const RobotDescription& robot, const TrackOdometrySettings& settings);

  void add(const Imu& imu);
  void add(const DriveTicks& ticks);
  /// Corrects the gyro bias about the vertical by a measurement from other sensors, rad/s.
  void correct_gyro_bias(double bias_radps, double std_radps) {
    imu_.correct_vertical_gyro_bias(bias_radps, std_radps);
  }

  /// Returns nullopt before a standstill of `settling_time_s` or the end of `init_timeout_s`.
  std::optional<OdometryEstimate> estimate() const;
  /// Returns the pose at a stamp within the motion history or slightly after it; otherwise nullopt.
  std::optional<Pose3> T_odom_body_at(Time stamp) const;
  /// Returns the standard deviation of the systematic velocity errors (scale, slip, bias), in body: forward m/s,
  /// left m/s, yaw rate rad/s. The pose error that they cause grows with the distance, not with its square root.
  Eigen::Vector3d twist_std() const;
  /// Returns the height of the body origin above the ground by the geometry of the robot, m.
  double height_above_ground_m() const { return robot_.body_height_m(); }

  TrackOdometryHealth health() const;
  /// Returns the estimates of the calibration, in the order of `kCalibrationParameters`: biases of the IMU and center
  /// of rotation; empty before the first IMU reading.
  std::vector<CalibrationValue> calibration() const;
  /// Returns the filter; nullopt before the first IMU reading.
  const std::optional<TrackFilter>& filter() const { return imu_.filter(); }

  template <typename Archive>
  void serialize_state(Archive& archive) {
    archive(imu_, started_, has_settled_, rest_detector_, slip_detector_, encoders_, pending_, last_speed_update_,
            last_speed_, is_slipping_, agree_since_, num_slip_events_);
  }

 private:
  void advance(Time stamp, const InertialSample& sample);
  void coast_to(const DriveTicks& ticks);
  /// Processes the encoder readings that are due.
  void process_pending();
  void use_ticks(const DriveTicks& ticks);
  double yaw_rate_disagreement_radps(const EncoderInterval& interval, const TrunkMotion& then) const;
  double stationary_slip_std(double yaw_rate_radps, double disagreement_radps) const;
  Eigen::Vector3d speed_std(const EncoderInterval& interval, const TrunkMotion& then, double disagreement_radps) const;
  /// Updates the slip state; returns whether the track speeds are usable.
  bool update_slip_state(const EncoderInterval& interval);
  /// Estimates the gyro bias with the tracks at rest, ends slip, and sets the origin after the first standstill.
  void update_standstill(const InertialSample& sample);
  void limit_velocity();
  bool encoders_timed_out() const;

  RobotDescription robot_;
  TrackOdometrySettings settings_;
  DifferentialGeometry geometry_;
  double skid_ratio_;
  bool is_mecanum_;
  double meters_per_tick_;
  StanceFeet track_ends_;  ///< ends of the tracks, which are at rest while the tracks are
  ImuFrontEnd<TrackFilter> imu_;

  Time started_{};
  bool has_settled_ = false;
  RestDetector rest_detector_;
  SlipDetector slip_detector_;

  TrackEncoders encoders_;
  PendingReadings<DriveTicks> pending_;  ///< waiting for the IMU
  std::optional<Time> last_speed_update_;
  Eigen::Vector3d last_speed_ = Eigen::Vector3d::Zero();  ///< body velocity at the last accepted encoder reading, m/s

  // Faults.
  bool is_slipping_ = false;
  std::optional<Time> agree_since_;  ///< start of the agreement of tracks and IMU after slip
  std::uint64_t num_slip_events_ = 0;
};

}  // namespace patrol::localize
