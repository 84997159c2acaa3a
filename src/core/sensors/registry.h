#pragma once

#include <array>
#include <cstddef>
#include <string>
#include <type_traits>
#include <variant>
#include <vector>

#include "core/sensors/antenna.h"
#include "core/sensors/barometer.h"
#include "core/sensors/depth_camera.h"
#include "core/sensors/foot_contact.h"
#include "core/sensors/gnss.h"
#include "core/sensors/hall.h"
#include "core/sensors/imu.h"
#include "core/sensors/joint_encoders.h"
#include "core/sensors/lidar.h"
#include "core/sensors/lidar3d.h"
#include "core/sensors/lidar_rear.h"
#include "core/sensors/magnetometer.h"
#include "core/sensors/scanner.h"
#include "core/sensors/tdlas.h"
#include "core/sensors/teleop.h"
#include "core/sensors/tem.h"
#include "core/sensors/ultrasonic.h"
#include "core/sensors/uwb.h"

namespace patrol {

/// Type list of sensor messages.
template <typename... Messages>
struct SensorList {
  using Variant = std::variant<Messages...>;

  /// Calls `visit` with a std::type_identity of each message.
  template <typename Visit>
  static void for_each(Visit&& visit) {
    (visit(std::type_identity<Messages>{}), ...);
  }
  /// Returns the registry entries in the order of the list.
  static constexpr std::array<SensorInfo, sizeof...(Messages)> infos() { return {SensorTraits<Messages>::kInfo...}; }
};

/// Registry of all sensors. A new sensor is added at the end. Within a tick, sensors are stepped and deliver in this
/// order, sensors that the firmware reads first.
using Sensors = SensorList<  //
    LaserScan,               //
    PointCloud,              //
    Imu,                     //
    JointState,              //
    FootContacts,            //
    GasReading,              //
    GnssFix,                 //
    TrackTicks,              //
    UwbRange,                //
    UltrasonicRange,         //
    DepthImage,              //
    TeleopCommand,           //
    PanoramicScan,           //
    AntennaState,            //
    TemSounding,             //
    MagneticField,           //
    FluidPressure,           //
    RearLaserScan            //
    >;

/// Message of any sensor.
using SensorMessage = Sensors::Variant;

/// Registry entries, indexed by SensorMessage::index().
inline constexpr auto kSensorInfos = Sensors::infos();

/// Returns the names of all sensors.
inline std::vector<std::string> sensor_names() {
  std::vector<std::string> names;
  for (const SensorInfo& info : kSensorInfos) names.emplace_back(info.name);
  return names;
}

inline Time stamp_of(const SensorMessage& message) {
  return std::visit([](const auto& content) { return content.stamp; }, message);
}

}  // namespace patrol
