#pragma once

#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "core/frames.h"
#include "core/ground_truth.h"
#include "core/random.h"
#include "core/robot_description.h"
#include "sim/as_built/as_built_settings.h"
#include "sim/as_built/device_clock.h"
#include "sim/as_built/scanner_errors.h"
#include "sim/as_built/sensor_errors.h"
#include "sim/as_built/uwb_power.h"

namespace patrol::sim {

/// Robot that is simulated: the nominal robot with manufacturing and calibration errors, which are constant over a run.
/// Ground truth: no part of it reaches the stack.
class AsBuiltRobot {
 public:
  /// Nominal robot.
  explicit AsBuiltRobot(RobotDescription nominal) : nominal_(std::move(nominal)), actual_(nominal_) {}
  /// Draws the robot of a seed within the tolerances; the nominal robot if the settings are disabled.
  AsBuiltRobot(const AsBuiltSettings& settings, RobotDescription nominal, std::uint64_t seed);

  /// Returns false for a nominal robot.
  bool is_as_built() const { return settings_.enabled; }
  /// Returns the robot's documents.
  const RobotDescription& nominal() const { return nominal_; }
  /// Returns the robot with the actual poses of its sensors.
  const RobotDescription& actual() const { return actual_; }
  /// Returns the actual body pose at the start for a surveyed start.
  Pose2 start(const Pose2& T_world_surveyed) const { return T_world_surveyed * T_surveyed_start_; }

  /// Returns the clock of a device: "firmware", or the name of a sensor.
  DeviceClock clock(const std::string& device) const;
  /// Returns the errors of a lidar by its frame. Measured errors are those of the frame `lidar` alone.
  LidarErrors lidar(const std::string& frame) const;
  ImuErrors imu() const;
  /// Returns the errors of the joint encoders; none of wheels, whose angle has no zero.
  JointErrors joints() const;
  TrackErrors tracks() const;
  WheelErrors wheels() const;
  double foot_friction_scale() const;
  /// Returns the range error of an anchor and the robot's antenna.
  double uwb_delay_m(int anchor) const;
  UwbPower uwb_power() const { return {settings_.enabled ? settings_.uwb.received_power_std_db : 0.0, seed_}; }
  DepthCameraErrors depth_camera() const;
  ScannerErrors scanner() const {
    return settings_.enabled ? sample_scanner_errors(settings_.scanner, seed_) : ScannerErrors{};
  }

  /// Returns the drawn values that the stack can estimate, and the sensor poses relative to the nominal ones; empty for
  /// a nominal robot. `sensor`: constant biases by the settings of the IMU, which add to the turn-on biases.
  AsBuiltTruth truth(const std::vector<int>& uwb_anchors, const ImuErrors& sensor = {}) const;

 private:
  RandomStream stream(const std::string& term) const;
  /// Returns a number with uniform distribution in +-`tolerance`.
  double uniform(const std::string& term, double tolerance, std::uint64_t index = 0) const;
  double normal(const std::string& term, double std, std::uint64_t index = 0) const;
  TriadErrors triad(const std::string& term, double bias_std, double bias_std_per_k) const;
  void mount_sensors();

  AsBuiltSettings settings_;
  std::uint64_t seed_ = 0;
  RobotDescription nominal_, actual_;
  Pose2 T_surveyed_start_;
};

/// Returns the actual pose of a sensor relative to its nominal one, from the values of `AsBuiltRobot::truth`; the
/// identity if these do not have the frame.
Pose3 mount_error(const AsBuiltTruth& truth, const std::string& frame);

}  // namespace patrol::sim
