#include "core/sensors/lidar.h"

#include <cmath>

#include "core/sensors/lidar_rear.h"

namespace patrol {

LidarSettings LidarSettings::of_preset(const std::string& name, bool enabled) {
  LidarSettings s;
  s.preset = name;
  s.enabled = enabled;
  if (name == "utm30lx") {
    s.rate_hz = 40.0, s.beams = 1081, s.fov_deg = 270.25, s.range_min_m = 0.1, s.range_quantization_m = 0.001;
    s.beam_width_deg = 0.25;
  } else if (name == "tim571") {
    s.rate_hz = 15.0, s.beams = 811, s.fov_deg = 270.33, s.range_max_m = 25.0, s.max_range_10pct_m = 8.0;
    s.range_noise_std_m = 0.02, s.range_quantization_m = 0.001, s.beam_width_deg = 0.33;
  } else if (name == "vlp16") {
    s.rate_hz = 10.0, s.beams = 1800, s.rings = 16, s.elevation_min_deg = -15.0, s.elevation_max_deg = 15.0;
    s.range_min_m = 0.5, s.range_max_m = 100.0, s.range_quantization_m = 0.002, s.max_range_10pct_m = 50.0;
    s.beam_width_deg = 0.17;
  }
  return s;
}

bool SensorTraits<LaserScan>::repeats(const LaserScan& now, const LaserScan& before) {
  bool has_return = false;
  for (std::size_t i = 0; i < now.ranges_m.size() && i < before.ranges_m.size(); ++i) {
    if (!std::isfinite(now.ranges_m[i]) && !std::isfinite(before.ranges_m[i])) continue;
    has_return = true;
    if (now.ranges_m[i] != before.ranges_m[i]) return false;
  }
  return has_return;  // scans without returns are identical, which is not a fault
}

std::vector<ErrorSource> SensorTraits<RearLaserScan>::error_sources() {
  return {{"lidar_rear: range noise",
           {"sensors.lidar_rear.range_noise_std_m=0", "sensors.lidar_rear.wide_noise_probability=0"}},
          {"lidar_rear: range quantization", {"sensors.lidar_rear.range_quantization_m=0"}},
          {"lidar_rear: beam angle", {"sensors.lidar_rear.angle_noise_std_deg=0"}},
          {"lidar_rear: mixed pixels", {"sensors.lidar_rear.beam_width_deg=0"}},
          {"lidar_rear: dropouts",
           {"sensors.lidar_rear.dropout_probability=0", "sensors.lidar_rear.max_incidence_deg=90",
            "sensors.lidar_rear.max_range_10pct_m=1000"}},
          {"lidar_rear: motion distortion", {"sensors.lidar_rear.motion_distortion=false"}}};
}

std::vector<ErrorSource> SensorTraits<LaserScan>::error_sources() {
  return {
      {"lidar: range noise", {"sensors.lidar.range_noise_std_m=0", "sensors.lidar.wide_noise_probability=0"}},
      {"lidar: range quantization", {"sensors.lidar.range_quantization_m=0"}},
      {"lidar: beam angle", {"sensors.lidar.angle_noise_std_deg=0"}},
      {"lidar: mixed pixels", {"sensors.lidar.beam_width_deg=0"}},
      {"lidar: dropouts",
       {"sensors.lidar.dropout_probability=0", "sensors.lidar.max_incidence_deg=90",
        "sensors.lidar.max_range_10pct_m=1000"}},
      {"lidar: rain and dust", {"sensors.lidar.false_return_rate_per_m=0", "sensors.dust.enabled=false"}},
      {"lidar: motion distortion", {"sensors.lidar.motion_distortion=false"}},
      {"lidar: tilt with the body", {"sensors.lidar.stabilized=true", "stack.scan_leveling.gimbal_stabilized=true"}}};
}

}  // namespace patrol
