#pragma once

#include <optional>

#include "core/robot_description.h"
#include "core/sensors/lidar.h"
#include "sim/sensors/sensor_suite_settings.h"

namespace patrol::app {

/// Lidar at whose height the surfaces of a world are compared with what a robot maps.
struct MappingLidar {
  const char* frame;
  LidarSettings sim::SensorSuiteSettings::*settings;
};

/// Returns the 2D lidar, or the 3D lidar of a robot without one; none for a robot without lidars.
inline std::optional<MappingLidar> mapping_lidar(const RobotDescription& robot) {
  using Settings = sim::SensorSuiteSettings;
  for (const MappingLidar& lidar :
       {MappingLidar{"lidar", &Settings::lidar}, MappingLidar{"lidar3d", &Settings::lidar3d}}) {
    if (robot.T_body_sensor.contains(lidar.frame)) return lidar;
  }
  return std::nullopt;
}

/// Returns the height of the mapping lidar in body; that of the body's origin for a robot without lidars.
inline double mapping_height_in_body_m(const RobotDescription& robot) {
  const std::optional<MappingLidar> lidar = mapping_lidar(robot);
  return lidar ? robot.T_body(lidar->frame).position.z() : 0.0;
}

}  // namespace patrol::app
