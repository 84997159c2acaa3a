#pragma once

#include <numbers>
#include <vector>

#include "core/sensors/sensor_traits.h"
#include "core/settings.h"
#include "core/time.h"

namespace patrol {

/// Joint positions, velocities and efforts in the order of RobotDescription::joint_names.
struct JointState {
  Time stamp{};
  std::vector<double> position_rad;
  std::vector<double> velocity_radps;
  std::vector<double> effort_nm;
};

/// Absolute magnetic encoders on the joints of legs, or encoders of driven wheels and steering joints; 14 bit. The
/// motor drive filters the velocity.
struct JointEncoderSettings {
  bool enabled = true;                             ///< presence of the sensor; false: no messages
  double rate_hz = 250.0;                          ///< message rate; the firmware reads the sensor at every tick
  int counts_per_revolution = 16384;               ///< number of encoder counts per revolution of a joint
  double velocity_filter_time_constant_s = 0.003;  ///< time constant of the velocity filter on count differences
  double latency_s = 0.0;                          ///< delay from the measurement to the delivery of the message

  /// Returns the counts per radian of a joint.
  double ticks_per_rad() const { return counts_per_revolution / (2.0 * std::numbers::pi); }

  template <typename Self, typename Visitor>
  static void fields(Self& self, Visitor& visit) {
    visit("enabled", self.enabled);
    visit("rate_hz", self.rate_hz, between(1.0, 500.0));
    visit("counts_per_revolution", self.counts_per_revolution, between(16, 1 << 24));
    visit("velocity_filter_time_constant_s", self.velocity_filter_time_constant_s, between(0.0, 0.1));
    visit("latency_s", self.latency_s, between(0.0, 10.0));
  }
};

template <>
struct SensorTraits<JointState> {
  struct Settings {
    JointEncoderSettings joint_encoders;
  };
  static constexpr auto kSettings = &Settings::joint_encoders;
  static constexpr SensorInfo kInfo = {.name = "joint_encoders",
                                       .topic = "/joint_states",
                                       .ros_type = "sensor_msgs/msg/JointState",
                                       .summary = "encoders of leg joints, or of wheels and steering",
                                       .timeout = SensorTimeout::kMotion,
                                       .freeze_check = FreezeCheck::kCommand,
                                       .is_required_to_drive = true,
                                       .is_read_by_firmware = true,
                                       .fault = {.unit = "rad", .drift_per_s = 0.01, .outlier = 0.3}};

  /// Adds to the main reading, the position of the first joint.
  static void add_to_reading(JointState& joints, double offset_rad) {
    if (!joints.position_rad.empty()) joints.position_rad.front() += offset_rad;
  }
  static bool repeats(const JointState& now, const JointState& before) {
    return now.position_rad == before.position_rad;
  }
  static bool is_fitted(const RobotDescription& robot) { return !robot.legs.empty() || !robot.wheels.empty(); }
  static std::vector<ErrorSource> error_sources() {
    return {{"joint encoders: counts", {"sensors.joint_encoders.counts_per_revolution=1000000"}}};
  }
};

}  // namespace patrol
