#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <vector>

#include "core/sensors/lidar.h"
#include "core/sensors/sensor_traits.h"
#include "core/time.h"

namespace patrol {

struct CloudPoint {
  float x, y, z;    ///< position, m, in `lidar3d`
  float intensity;  ///< intensity, 0 ... 255
  float time_s;     ///< time after the cloud's stamp
  std::uint16_t ring;
};

/// Revolution of a 3D lidar. Contains returns only.
struct PointCloud {
  Time stamp{};  ///< instant of the first firing
  std::vector<CloudPoint> points;
};

template <>
struct SensorTraits<PointCloud> {
  struct Settings {
    LidarSettings lidar3d = LidarSettings::of_preset("vlp16", false);
  };
  static constexpr auto kSettings = &Settings::lidar3d;
  static constexpr SensorInfo kInfo = {.name = "lidar3d",
                                       .topic = "/points",
                                       .ros_type = "sensor_msgs/msg/PointCloud2",
                                       .summary = "3D lidar",
                                       .frame = "lidar3d",
                                       .timeout = SensorTimeout::kLidar,
                                       .fault = {.unit = "m", .drift_per_s = 0.02, .outlier = 1.0}};

  /// Adds to the ranges; points that would be behind the sensor are in it.
  static void add_to_reading(PointCloud& cloud, double offset_m) {
    for (CloudPoint& point : cloud.points) {
      const float range_m = std::hypot(point.x, point.y, point.z);
      if (!(range_m > 0.0F)) continue;
      const float scale = std::max(0.0F, 1.0F + static_cast<float>(offset_m) / range_m);
      point.x *= scale;
      point.y *= scale;
      point.z *= scale;
    }
  }
};

}  // namespace patrol
