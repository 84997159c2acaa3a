#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "core/calibration/calibration_estimate.h"
#include "core/messages.h"
#include "core/robot_description.h"
#include "core/sensors/registry.h"
#include "localize/frozen_readings.h"
#include "localize/imu_front_end.h"
#include "localize/inertial_filter.h"
#include "localize/leg_odometry.h"
#include "localize/legged_odometry_settings.h"
#include "localize/pending_readings.h"

namespace patrol::localize {

/// Health of the legged odometry, for the log and for the sensor monitor.
struct EstimatorHealth {
  bool imu_timed_out = false;       ///< the estimate is propagated by the feet alone
  bool legs_timed_out = false;      ///< the estimate is propagated by the IMU alone
  bool contacts_timed_out = false;  ///< stance feet are selected by their height
  double gyro_z_bias_std_radps = 0.0;
  std::uint64_t num_rejected_messages = 0;  ///< messages not finite, of the wrong size, frozen, or outdated
  std::uint64_t num_slips = 0;              ///< number of readings of a stance foot that slips
};

/// Legged odometry: pose of the trunk in `odom` from IMU, joint encoders and foot forces, at the newest reading.
///
/// Messages may be late, out of order or missing. Joint readings wait for the IMU reading of their stamp, at most
/// `imu_timeout_s`; then the feet alone propagate the estimate. Readings older than the state are compared with the
/// motion history. Not handled: a robot that is lifted or falls.
class LeggedOdometry {
 public:
  LeggedOdometry(const RobotDescription& robot, const LeggedOdometrySettings& settings);

  void add(const Imu& imu);
  void add(const JointState& joints);
  void add(const FootContacts& contacts);
  /// Corrects the gyro bias about the vertical by a measurement from other sensors, rad/s.
  void correct_gyro_bias(double bias_radps, double std_radps) {
    imu_.correct_vertical_gyro_bias(bias_radps, std_radps);
  }

  /// Returns nullopt before the first readings of both the IMU and the legs.
  std::optional<OdometryEstimate> estimate() const;
  /// Returns the pose at a stamp within the motion history or slightly after it; otherwise nullopt.
  std::optional<Pose3> T_odom_body_at(Time stamp) const;
  /// Returns the height of the body origin above the ground under the feet, m.
  double height_above_ground_m() const { return height_m_; }

  EstimatorHealth health() const;
  /// Returns the estimates of the calibration, in the order of `kCalibrationParameters`: biases of the IMU; empty
  /// before the first IMU reading.
  std::vector<CalibrationValue> calibration() const;
  /// Returns the filter; nullopt before the first IMU reading.
  const std::optional<InertialFilter>& filter() const { return imu_.filter(); }

  template <typename Archive>
  void serialize_state(Archive& archive) {
    archive(imu_, contact_, pending_, last_contacts_, contact_weights_, last_leg_update_, height_m_, frozen_joints_,
            frozen_contacts_, joints_move_, contacts_timed_out_, num_slips_);
  }

 private:
  void advance(Time stamp, const InertialSample& sample);
  /// Processes the leg readings that are due.
  void process_pending();
  void use_legs(const LegSample& sample);
  void coast_to(const LegSample& sample);
  StanceFeet stance_feet(const LegSample& sample) const;
  StanceFeet lowest_feet(const LegSample& sample) const;
  void measure_standstill(const LegSample& sample, const TrunkMotion& then, const StanceFeet& feet);
  void limit_velocity();

  RobotDescription robot_;
  LeggedOdometrySettings settings_;
  ImuFrontEnd<InertialFilter> imu_;

  ContactDetector contact_;
  PendingReadings<LegSample> pending_;  ///< waiting for IMU and foot forces
  std::optional<Time> last_contacts_;
  ContactWeights contact_weights_{};  ///< contact weights at `last_contacts_`
  std::optional<Time> last_leg_update_;
  double height_m_ = 0.0;

  // Faults.
  FrozenReadings<3 * kNumLegs> frozen_joints_;
  FrozenReadings<kNumLegs> frozen_contacts_;
  bool joints_move_ = false;
  bool contacts_timed_out_ = false;
  std::uint64_t num_slips_ = 0;
};

}  // namespace patrol::localize
