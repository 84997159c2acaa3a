#pragma once

#include <cstdint>
#include <optional>

#include "core/messages.h"
#include "core/robot_description.h"
#include "core/sensors/registry.h"
#include "localize/track_encoders.h"
#include "localize/imu_front_end.h"
#include "localize/pending_readings.h"
#include "localize/slip_detector.h"
#include "localize/track_filter.h"
#include "localize/track_odometry_settings.h"

namespace patrol::localize {

/// How the odometry fares, for the log and for whoever must decide whether to drive on.
struct TrackOdometryHealth {
  bool imu_is_silent = false;     ///< going on by the belts alone
  bool ticks_are_silent = false;  ///< going on by the IMU alone: nothing heard, or nothing that can be believed
  bool grip_is_lost = false;      ///< belts and body do not go alike (or the counters are frozen): going on by the IMU
  double gyro_z_bias_std_radps = 0.0;
  std::uint64_t rejected_messages = 0;  ///< not finite, frozen, implausible, or older than what was already used
  std::uint64_t slip_events = 0;
};

/// Where the body of a tracked robot is in `odom`, from the counters of its belts and an IMU: TrackFilter fed with messages. The
/// estimate is at its newest reading; odom starts, level, where the robot has first stood for a while.
///
/// Messages may come late or not at all: counters wait for the IMU of their instant (up to `imu_timeout_s`, then the belts carry
/// on alone), and are compared with the state remembered from the middle of their interval. When belts and body agree again after a
/// loss of grip, what the IMU has drifted meanwhile is taken back: odom then shifts by decimeters, once. Not handled: a robot that is carried,
/// and belts that lose their grip so gently that the accelerometer cannot feel it (below `slip_disagreement_mps` in
/// `slip_window_s`).
class TrackOdometry {
 public:
  /// Throws InputError for a robot without tracks or without a frame `imu`.
  TrackOdometry(const RobotDescription& robot, const TrackOdometrySettings& settings);

  void add(const Imu& imu);
  void add(const TrackTicks& ticks);

  /// None before the robot has stood for `settling_time_s`, or `init_timeout_s` have passed.
  std::optional<OdometryEstimate> estimate() const;
  /// The body at an instant of the last seconds, or slightly after the newest; none outside of that.
  std::optional<Pose3> T_odom_body_at(Time stamp) const;
  /// Standard deviation of what is wrong with the velocity for longer than moments, in body: ahead m/s, to the left m/s, yaw rate
  /// rad/s. These errors last (scale, slip, bias): what they add to a pose grows with the way, not with its root.
  Eigen::Vector3d twist_std() const;
  /// Of the body's origin above the ground, m, by the robot's geometry.
  double height_above_ground_m() const { return robot_.tracks->body_height_m; }

  TrackOdometryHealth health() const;
  /// The filter behind; none before the first IMU reading.
  const std::optional<TrackFilter>& filter() const { return imu_.filter(); }

 private:
  void advance(Time stamp, const InertialSample& sample);
  void coast_to(const TrackTicks& ticks);
  /// Uses the counters that are due.
  void take_pending();
  void use_ticks(const TrackTicks& ticks);
  double yaw_rate_disagreement_radps(const EncoderInterval& belts, const TrunkMotion& then) const;
  double usual_slip_std(double yaw_rate_radps, double disagreement_radps) const;
  Eigen::Vector3d speed_std(const EncoderInterval& belts, const TrunkMotion& then, double disagreement_radps) const;
  /// Whether the belts say what the body does.
  bool watch_grip(const EncoderInterval& belts);
  /// With the belts at rest: bias, slip, and whether the odometry may begin.
  void watch_standstill(const InertialSample& sample);
  void hold_velocity();
  bool ticks_are_silent() const;

  RobotDescription robot_;
  TrackOdometrySettings settings_;
  double meters_per_tick_;
  StanceFeet track_ends_;  ///< these stand still while the belts do
  ImuFrontEnd<TrackFilter> imu_;

  Time started_{};
  bool has_settled_ = false;
  SlipDetector slip_watch_;

  TrackEncoders counters_;
  PendingReadings<TrackTicks> pending_;  ///< waiting for the IMU
  std::optional<Time> last_speed_update_;
  Eigen::Vector3d last_speed_ = Eigen::Vector3d::Zero();  ///< of the body, when the belts were last believed, m/s

  // Faults.
  bool grip_is_lost_ = false;
  std::optional<Time> agree_since_;  ///< belts and IMU, after that
  std::uint64_t slip_events_ = 0;
};

}  // namespace patrol::localize
