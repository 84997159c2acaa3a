#pragma once

#include <vector>

#include "core/sensors/lidar.h"
#include "core/sensors/sensor_traits.h"

namespace patrol {

/// Revolution of the second 2D lidar; angles are in the frame `lidar_rear`.
struct RearLaserScan : LaserScan {};

template <>
struct SensorTraits<RearLaserScan> {
  struct Settings {
    LidarSettings lidar_rear = LidarSettings::of_preset("rplidar_s2", false);
  };
  static constexpr auto kSettings = &Settings::lidar_rear;
  static constexpr SensorInfo kInfo = {.name = "lidar_rear",
                                       .topic = "/scan_rear",
                                       .ros_type = "sensor_msgs/msg/LaserScan",
                                       .summary = "second 2D lidar",
                                       .frame = "lidar_rear",
                                       .timeout = SensorTimeout::kLidar,
                                       .freeze_check = FreezeCheck::kOdometry,
                                       .fault = {.unit = "m", .drift_per_s = 0.02, .outlier = 1.0}};

  static void add_to_reading(RearLaserScan& scan, double offset_m) {
    SensorTraits<LaserScan>::add_to_reading(scan, offset_m);
  }
  static bool repeats(const RearLaserScan& now, const RearLaserScan& before) {
    return SensorTraits<LaserScan>::repeats(now, before);
  }
  static std::vector<ErrorSource> error_sources();
};

}  // namespace patrol
