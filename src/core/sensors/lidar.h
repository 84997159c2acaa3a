#pragma once

#include <string>
#include <vector>

#include "core/sensors/sensor_traits.h"
#include "core/settings.h"
#include "core/time.h"

namespace patrol {

/// Revolution of a 2D lidar. Ranges follow REP 117: -Inf too close, +Inf no return, NaN invalid.
struct LaserScan {
  Time stamp{};                      ///< instant of beam 0
  double angle_min_rad = 0.0;        ///< angle of beam 0, in `lidar`, about z
  double angle_increment_rad = 0.0;  ///< angle between consecutive beams
  double time_increment_s = 0.0;     ///< time between consecutive beams
  double scan_time_s = 0.0;          ///< time between consecutive scans
  double range_min_m = 0.0;
  double range_max_m = 0.0;
  std::vector<float> ranges_m;     ///< ranges, [beam]
  std::vector<float> intensities;  ///< intensities, [beam], 0 ... 255, or empty
};

/// Spinning lidar with one or more rings. Defaults are those of the preset.
struct LidarSettings {
  std::string preset = "rplidar_s2";     ///< model of the sensor, whose data sheet gives the defaults of the other keys
  bool enabled = true;                   ///< presence of the sensor; false: no messages
  double rate_hz = 10.0;                 ///< revolutions per second
  int beams = 3200;                      ///< firings per revolution, within the field of view
  int rings = 1;                         ///< number of rings of beams above each other
  double fov_deg = 360.0;                ///< horizontal field of view, symmetric about the front
  double elevation_min_deg = 0.0;        ///< elevation of the lowest ring
  double elevation_max_deg = 0.0;        ///< elevation of the highest ring
  double range_min_m = 0.05;             ///< minimum range of a return
  double range_max_m = 30.0;             ///< maximum range of a return
  double range_noise_std_m = 0.015;      ///< standard deviation of the range
  double range_quantization_m = 0.013;   ///< quantization step of the range
  double wide_noise_probability = 0.0;   ///< probability of additional noise of a range, which gives it long tails
  double wide_noise_std_m = 0.0;         ///< standard deviation of the additional noise
  double angle_noise_std_deg = 0.01;     ///< standard deviation of the beam azimuth
  double beam_width_deg = 0.12;          ///< azimuthal width of the beam; causes mixed pixels at edges
  double dropout_probability = 0.002;    ///< dropout probability of a beam
  double max_incidence_deg = 85.0;       ///< maximum angle of incidence; beams beyond it are lost
  double max_range_10pct_m = 10.0;       ///< maximum range on a surface of 10 % reflectivity
  double false_return_rate_per_m = 0.0;  ///< rate of returns from raindrops or dust grains, per meter of beam
  double latency_s = 0.005;              ///< delay from the last beam to the message
  /// Presence of motion distortion; false: all beams are fired from the pose at the end of the revolution.
  bool motion_distortion = true;
  /// Presence of an ideal gimbal that keeps the lidar level; requires stack.scan_leveling.gimbal_stabilized.
  bool stabilized = false;

  /// Returns the settings of a preset, from public data sheets. "rplidar_s2": Slamtec RPLIDAR S2 (10 Hz, 32,000
  /// samples/s, 0.05-30 m, 10 m on 10 %, +-30 mm, 13 mm steps). "utm30lx": Hokuyo UTM-30LX (40 Hz, 0.25 deg over 270
  /// deg, 0.1-30 m, +-30 mm, 1 mm steps). "tim571": SICK TiM571 (15 Hz, 0.33 deg over 270 deg, 0.05-25 m, 8 m on 10 %,
  /// statistical 20 mm, systematic +-60 mm). "vlp16": Velodyne VLP-16 (10 Hz, 16 rings over +-15 deg, 1,800 firings,
  /// 100 m, +-30 mm, 2 mm steps, 3 mrad wide).
  ///
  /// `range_noise_std_m` is the part of the stated error that is drawn for each beam; the constant part of one device
  /// is an as-built error, not a setting of the preset. SICK states both (TiM55x/TiM56x, 8015886, p. 4, typical
  /// values): a statistical error of 20 mm at one standard deviation and a systematic one of +-60 mm. The other sheets
  /// give one bound for noise and bias together. Half of it is the standard deviation of the noise, since 95 % of the
  /// readings of a device without bias lie within the bound. The bound on the bias of one device is the same +-30 mm,
  /// because a mean of many readings may lie anywhere within it.
  ///
  /// The data sheets of the first three state no beam width; about the angle between beams is assumed.
  static LidarSettings of_preset(const std::string& name, bool enabled = true);

  template <typename Self, typename Visitor>
  static void fields(Self& self, Visitor& visit) {
    visit("preset", self.preset, one_of({"rplidar_s2", "utm30lx", "tim571", "vlp16"}));
    visit("enabled", self.enabled);
    visit("rate_hz", self.rate_hz, between(0.5, 100.0));
    visit("beams", self.beams, between(4, 100000));
    visit("rings", self.rings, between(1, 128));
    visit("fov_deg", self.fov_deg, between(1.0, 360.0));
    visit("elevation_min_deg", self.elevation_min_deg, between(-90.0, 90.0));
    visit("elevation_max_deg", self.elevation_max_deg, between(-90.0, 90.0));
    visit("range_min_m", self.range_min_m, at_least(0.0));
    visit("range_max_m", self.range_max_m, between(0.1, 400.0));
    visit("range_noise_std_m", self.range_noise_std_m, at_least(0.0));
    visit("range_quantization_m", self.range_quantization_m, at_least(0.0));
    visit("wide_noise_probability", self.wide_noise_probability, between(0.0, 1.0));
    visit("wide_noise_std_m", self.wide_noise_std_m, at_least(0.0));
    visit("angle_noise_std_deg", self.angle_noise_std_deg, between(0.0, 10.0));
    visit("beam_width_deg", self.beam_width_deg, between(0.0, 5.0));
    visit("dropout_probability", self.dropout_probability, between(0.0, 1.0));
    visit("max_incidence_deg", self.max_incidence_deg, between(0.0, 90.0));
    visit("max_range_10pct_m", self.max_range_10pct_m, at_least(0.0));
    visit("false_return_rate_per_m", self.false_return_rate_per_m, between(0.0, 1.0));
    visit("latency_s", self.latency_s, between(0.0, 10.0));
    visit("motion_distortion", self.motion_distortion);
    visit("stabilized", self.stabilized);
  }
};

template <>
struct SensorTraits<LaserScan> {
  struct Settings {
    LidarSettings lidar = LidarSettings::of_preset("rplidar_s2");
  };
  static constexpr auto kSettings = &Settings::lidar;
  static constexpr SensorInfo kInfo = {.name = "lidar",
                                       .topic = "/scan",
                                       .ros_type = "sensor_msgs/msg/LaserScan",
                                       .summary = "2D lidar",
                                       .frame = "lidar",
                                       .timeout = SensorTimeout::kLidar,
                                       .freeze_check = FreezeCheck::kOdometry,
                                       .is_required_to_drive = true,
                                       .fault = {.unit = "m", .drift_per_s = 0.02, .outlier = 1.0}};

  static void add_to_reading(LaserScan& scan, double offset_m) {
    for (float& range_m : scan.ranges_m) range_m += static_cast<float>(offset_m);
  }
  static bool repeats(const LaserScan& now, const LaserScan& before);
  static std::vector<ErrorSource> error_sources();
};

}  // namespace patrol
