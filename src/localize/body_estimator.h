#pragma once

#include <cstdint>
#include <optional>

#include "core/messages.h"
#include "core/robot_description.h"
#include "core/sensors/registry.h"
#include "localize/body_estimator_settings.h"
#include "localize/frozen_readings.h"
#include "localize/imu_front_end.h"
#include "localize/inertial_filter.h"
#include "localize/leg_odometry.h"
#include "localize/pending_readings.h"

namespace patrol::localize {

/// How the estimator fares, for the log and for whoever must decide whether to walk on.
struct EstimatorHealth {
  bool imu_is_silent = false;        ///< going on by the feet alone
  bool legs_are_silent = false;      ///< going on by the IMU alone
  bool contacts_are_silent = false;  ///< guessing by the feet's heights which of them stand
  double gyro_z_bias_std_radps = 0.0;
  std::uint64_t rejected_messages =
      0;                    ///< not finite, of the wrong size, frozen, or older than what was already used
  std::uint64_t slips = 0;  ///< readings of a standing foot that was found slipping
};

/// Where the trunk is in `odom`, from IMU, joint encoders and foot forces; the estimate is at its newest
/// reading.
///
/// Messages may come late, out of order or not at all: joints wait for the IMU of their instant (up to
/// `imu_timeout_s`, then the feet carry on alone), and what comes after its instant has passed is compared
/// with the state remembered from then. Not handled: a robot that is lifted or falls.
class BodyEstimator {
 public:
  BodyEstimator(const RobotDescription& robot, const BodyEstimatorSettings& settings);

  void add(const Imu& imu);
  void add(const JointState& joints);
  void add(const FootContacts& contacts);

  /// None before the IMU and the legs have both been heard.
  std::optional<OdometryEstimate> estimate() const;
  /// The body at an instant of the last seconds, or slightly after the newest; none outside of that.
  std::optional<Pose3> T_odom_body_at(Time stamp) const;
  /// Of the body's origin above the ground under its feet, m.
  double height_above_ground_m() const { return height_m_; }

  EstimatorHealth health() const;
  /// The filter behind; none before the first IMU reading.
  const std::optional<InertialFilter>& filter() const { return imu_.filter(); }

 private:
  void advance(Time stamp, const InertialSample& sample);
  /// Uses the leg readings that are due.
  void take_pending();
  void use_legs(const LegSample& sample);
  void coast_to(const LegSample& sample);
  StanceFeet stance_feet(const LegSample& sample) const;
  StanceFeet lowest_feet(const LegSample& sample) const;
  void measure_standstill(const LegSample& sample, const TrunkMotion& then, const StanceFeet& feet);
  void hold_velocity();

  RobotDescription robot_;
  BodyEstimatorSettings settings_;
  ImuFrontEnd<InertialFilter> imu_;

  ContactDetector contact_;
  PendingReadings<LegSample> pending_;  ///< waiting for IMU and foot forces
  std::optional<Time> last_contacts_;
  ContactWeights trust_{};  ///< then
  std::optional<Time> last_leg_update_;
  double height_m_ = 0.0;

  // Faults.
  FrozenReadings<3 * kNumLegs> frozen_joints_;
  FrozenReadings<kNumLegs> frozen_contacts_;
  bool joints_move_ = false;
  bool contacts_are_silent_ = false;
  std::uint64_t slips_ = 0;
};

}  // namespace patrol::localize
