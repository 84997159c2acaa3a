#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "core/calibration/calibration_estimate.h"
#include "core/messages.h"
#include "core/robot_description.h"
#include "core/sensors/registry.h"
#include "core/state/state_archive_fwd.h"
#include "stack/settings/stack_settings.h"

namespace patrol::stack {

/// Interface of an odometry: pose of the body in `odom` from the robot's proprioceptive sensors.
class OdometrySource {
 public:
  virtual ~OdometrySource() = default;

  /// Processes a sensor message; called for all types, of which a source ignores those that it does not use.
  virtual void add(const SensorMessage& message) = 0;
  /// Corrects the gyro bias about the vertical by a measurement from other sensors, rad/s.
  virtual void correct_gyro_bias(double bias_radps, double std_radps) = 0;
  /// Returns the newest estimate; none before the source has settled.
  virtual std::optional<OdometryEstimate> estimate() const = 0;
  /// Returns the pose at an instant of the last seconds, or slightly after the newest reading; none outside that span.
  virtual std::optional<Pose3> T_odom_body_at(Time stamp) const = 0;
  /// Returns the height of the body's origin above the ground, m.
  virtual double height_above_ground_m() const = 0;
  /// Returns the standard deviation of the systematic velocity errors, in body: forward m/s, left m/s, yaw rate rad/s.
  virtual Eigen::Vector3d twist_std() const = 0;
  /// Returns the calibration parameters that the source estimates; empty before its first IMU reading.
  virtual std::vector<CalibrationValue> calibration() const = 0;

  /// Saves or restores the state.
  virtual void serialize_state(StateArchive& archive) = 0;
};

/// Makes the source named by `settings.odometry_source`. Throws InputError if the robot lacks what the source needs.
std::unique_ptr<OdometrySource> make_odometry_source(const StackSettings& settings, const RobotDescription& robot);

}  // namespace patrol::stack
