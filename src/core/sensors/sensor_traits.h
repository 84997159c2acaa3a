#pragma once

#include <string>
#include <vector>

#include "core/robot_description.h"

/// Description of a sensor type. Each header core/sensors/<name>.h holds the message of one sensor, the settings of
/// its simulation and its registry entry, a specialization of SensorTraits; core/sensors/registry.h lists the
/// messages. Twin, faults, sensor monitor, log, fault matrix, error budget, settings and `patrol list` derive from
/// that list.
namespace patrol {

/// Age limit that the sensor monitor applies to a sensor's messages.
enum class SensorTimeout { kNone, kLidar, kMotion, kInstrument };

/// Motion by which the sensor monitor recognizes a frozen sensor: readings that repeat while odometry, or the
/// velocity command, says that the robot moves.
enum class FreezeCheck { kNone, kOdometry, kCommand };

/// Occasion on which a sensor publishes.
enum class SensorTrigger { kPeriodic, kScanStation, kTeleoperation };

/// Magnitudes of the faults of a sensor's main reading in the fault matrix: well beyond its noise, as of a damaged
/// sensor.
struct FaultMagnitudes {
  const char* unit = "";  ///< unit of the main reading
  double drift_per_s = 0.0;
  double spike = 0.0;
};

/// Registry entry of a sensor type.
struct SensorInfo {
  const char* name;      ///< key of its settings below `sensors`, and its name in faults and events
  const char* topic;     ///< in the log
  const char* ros_type;  ///< e.g. "sensor_msgs/msg/Imu"
  const char* summary;   ///< line of documentation in `patrol list`
  SensorTimeout timeout = SensorTimeout::kNone;
  FreezeCheck freeze_check = FreezeCheck::kNone;
  bool is_needed_to_drive = false;     ///< the robot halts while the sensor monitor reports a fault of it
  bool is_read_by_firmware = false;    ///< the locomotion firmware reads it at every tick; stepped before the others
  SensorTrigger trigger = SensorTrigger::kPeriodic;
  FaultMagnitudes fault = {};
  const char* not_in_fault_matrix = "";  ///< reason for its absence from the fault matrix; empty: it is in the matrix
};

/// Error source of a sensor that the error budget removes by settings that leave everything else as it is.
struct ErrorSource {
  std::string name;
  std::vector<std::string> overrides;  ///< "path=value"
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
///     static void add_to_reading(UwbRange& range, double offset);  // main reading, for drift and spikes
///     static bool repeats(const UwbRange& now, const UwbRange& before);  // only with a FreezeCheck
///     static bool is_fitted(const RobotDescription& robot);  // absent: on any robot
///     static std::vector<ErrorSource> error_sources();  // absent: none
///   };
template <typename Message>
struct SensorTraits;

/// Message of a registered sensor.
template <typename Message>
concept IsSensorMessage = requires { SensorTraits<Message>::kInfo; };

/// Sensor with settings.
template <typename Message>
concept HasSensorSettings = requires { SensorTraits<Message>::kSettings; };

/// Returns whether this kind of robot can carry the sensor.
template <IsSensorMessage Message>
bool is_fitted(const RobotDescription& robot) {
  if constexpr (requires { SensorTraits<Message>::is_fitted(robot); }) {
    return SensorTraits<Message>::is_fitted(robot);
  } else {
    return true;
  }
}

/// Returns whether `now` repeats the reading of `before` to the last bit; always false for sensors without a
/// FreezeCheck.
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
