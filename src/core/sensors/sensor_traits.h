#pragma once

#include <string>
#include <vector>

#include "core/robot_description.h"

/// Description of a sensor type.
///
/// Each header core/sensors/<name>.h contains the message of one sensor, the settings of its simulation and its
/// registry entry, a specialization of SensorTraits. core/sensors/registry.h lists the messages. Simulator, faults,
/// sensor monitor, log, fault matrix, error budget, settings and `patrol list` derive from that list.
namespace patrol {

/// Age limit that the sensor monitor applies to a sensor's messages.
enum class SensorTimeout { kNone, kLidar, kMotion, kInstrument };

/// Reference motion for detecting a frozen sensor: its readings repeat while odometry, or the velocity command,
/// indicates motion.
enum class FreezeCheck { kNone, kOdometry, kCommand };

/// Condition under which a sensor publishes.
enum class SensorTrigger { kPeriodic, kScanStation, kTeleoperation };

/// Fault magnitudes of a sensor's main reading in the fault matrix. They are well beyond the noise, as of a damaged
/// sensor.
struct FaultMagnitudes {
  const char* unit = "";  ///< unit of the main reading
  double drift_per_s = 0.0;
  double outlier = 0.0;
};

/// Registry entry of a sensor type.
struct SensorInfo {
  const char* name = "";      ///< settings key below `sensors`, and sensor name in faults and events
  const char* topic = "";     ///< topic in the log
  const char* ros_type = "";  ///< ROS message type, e.g. "sensor_msgs/msg/Imu"
  const char* summary = "";   ///< line of documentation in `patrol list`
  const char* frame = "";     ///< frame of the robot that the sensor needs; empty: it needs none
  SensorTimeout timeout = SensorTimeout::kNone;
  FreezeCheck freeze_check = FreezeCheck::kNone;
  bool is_required_to_drive = false;  ///< true: the robot stops while the sensor monitor reports a fault of this
                                      ///< sensor
  bool is_read_by_firmware = false;   ///< true: the locomotion firmware reads the sensor at every tick; stepped before
                                      ///< the others
  SensorTrigger trigger = SensorTrigger::kPeriodic;
  FaultMagnitudes fault = {};
  const char* fault_matrix_exclusion_reason = "";  ///< reason for exclusion from the fault matrix; empty: included
};

/// Error source of a sensor. The error budget removes it with settings that change nothing else.
struct ErrorSource {
  std::string name;
  std::vector<std::string> overrides;  ///< settings as "path=value"
};

/// Registry entry of the sensor that publishes `Message`:
///
///   template <>
///   struct SensorTraits<UwbRange> {
///     struct Settings {
///       UwbSettings uwb;  // the member that SensorSuiteSettings has for it; `Settings` may be empty
///     };
///     static constexpr auto kSettings = &Settings::uwb;  // absent if `Settings` is empty
///     static constexpr SensorInfo kInfo = {...};
///     static void add_to_reading(UwbRange& range, double offset);  // main reading, for drift and outliers
///     static bool repeats(const UwbRange& now, const UwbRange& before);  // only with a FreezeCheck
///     static bool is_fitted(const RobotDescription& robot);  // absent: on any robot
///     static std::vector<ErrorSource> error_sources();  // absent: none
///   };
template <typename Message>
struct SensorTraits;

/// Message of a registered sensor.
template <typename Message>
concept IsSensorMessage = requires {
  SensorTraits<Message>::kInfo;
};

/// Sensor with settings.
template <typename Message>
concept HasSensorSettings = requires {
  SensorTraits<Message>::kSettings;
};

/// Returns whether this kind of robot can carry the sensor.
template <IsSensorMessage Message>
bool is_fitted(const RobotDescription& robot) {
  if constexpr (requires { SensorTraits<Message>::is_fitted(robot); }) {
    return SensorTraits<Message>::is_fitted(robot);
  } else {
    return true;
  }
}

/// Returns whether `now` repeats the reading of `before` bit by bit; always false for sensors without a FreezeCheck.
template <IsSensorMessage Message>
bool repeats(const Message& now, const Message& before) {
  if constexpr (requires { SensorTraits<Message>::repeats(now, before); }) {
    return SensorTraits<Message>::repeats(now, before);
  } else {
    return false;
  }
}

template <IsSensorMessage Message>
std::vector<ErrorSource> error_sources() {
  if constexpr (requires { SensorTraits<Message>::error_sources(); }) {
    return SensorTraits<Message>::error_sources();
  } else {
    return {};
  }
}

}  // namespace patrol
