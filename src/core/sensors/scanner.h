#pragma once

#include <cmath>
#include <string>
#include <vector>

#include "core/sensors/sensor_traits.h"
#include "core/settings.h"
#include "core/time.h"

namespace patrol {

struct ScannerPoint {
  float x, y, z;    ///< position, m, in `scanner_level`
  float intensity;  ///< intensity, 0 ... 255
};

/// Stationary panoramic scan of the 3D scanner, returns only, in the order of its columns. `scanner_level` has the
/// origin and heading of `scanner` and is gravity-aligned: the instrument's compensator corrects the tilt that it
/// measures.
struct PanoramicScan {
  Time stamp{};  ///< instant of the last point
  std::vector<ScannerPoint> points;
};

/// Terrestrial laser scanner. Defaults are those of FARO's Focus S 70 technical sheet. Range: 0.6 to 70 m (black, 2 %:
/// to 50 m). Ranging noise on 90, 10 and 2 %: 0.3, 0.4 and 1.3 mm at 10 m; 0.3, 0.5 and 2.0 mm at 25 m. Systematic
/// ranging error +-1 mm, angular accuracy 19", compensator 19". Beam: 2.12 mm wide at the exit, divergence 0.3 mrad.
/// Field of view: 360 degrees horizontal, 300 degrees vertical, in steps of 0.009 degrees (here: every 40th). A stated
/// "+-" is read as two standard deviations, a plain value as one.
struct PanoramicScannerSettings {
  bool enabled = false;  ///< presence of the sensor; false: no messages
  std::string epoch =
      "inspection";        ///< measurement epoch of a scan: "reference" or "inspection"; independent noise in each
  double step_deg = 0.36;  ///< angle between beams, horizontal and vertical; default: 1000 columns of 417
  double elevation_min_deg = -60.0;       ///< lowest elevation; below it the instrument's own tripod blocks the beams
  double duration_s = 30.0;               ///< duration of a scan
  double range_min_m = 0.6;               ///< minimum range of the sensor
  double range_max_m = 70.0;              ///< maximum range of the sensor
  double max_range_2pct_m = 50.0;         ///< maximum range on a surface of 2 % reflectivity
  double range_noise_std_m = 0.0003;      ///< standard deviation of the range on a bright surface
  double gray_noise_std_m = 0.000255;     ///< additional standard deviation on 10 % reflectivity at 10 m, added in
                                          ///< squares; scales with sqrt(range) / light
  double range_offset_std_m = 0.0005;     ///< standard deviation of a range error that is constant within a scan
  double angle_noise_std_deg = 0.0053;    ///< standard deviation of each beam's azimuth and elevation
  double tilt_error_std_deg = 0.0053;     ///< standard deviation of the tilt residual of the compensator, about each of
                                          ///< two axes
  double beam_exit_diameter_m = 0.00212;  ///< beam diameter at the exit
  double beam_divergence_rad = 0.0003;    ///< beam divergence, half angle; 0 disables the beam width and mixed pixels
  double max_incidence_deg = 85.0;        ///< maximum angle of incidence; beams beyond it are lost
  double dropout_probability = 0.001;     ///< dropout probability of a beam
  double latency_s = 0.5;                 ///< delay from the last point to the message

  template <typename Self, typename Visitor>
  static void fields(Self& self, Visitor& visit) {
    visit("enabled", self.enabled);
    visit("epoch", self.epoch, one_of({"reference", "inspection"}));
    visit("step_deg", self.step_deg, between(0.09, 10.0));
    visit("elevation_min_deg", self.elevation_min_deg, between(-90.0, 80.0));
    visit("duration_s", self.duration_s, between(0.1, 3600.0));
    visit("range_min_m", self.range_min_m, at_least(0.0));
    visit("range_max_m", self.range_max_m, between(1.0, 400.0));
    visit("max_range_2pct_m", self.max_range_2pct_m, between(1.0, 400.0));
    visit("range_noise_std_m", self.range_noise_std_m, between(0.0, 1.0));
    visit("gray_noise_std_m", self.gray_noise_std_m, between(0.0, 1.0));
    visit("range_offset_std_m", self.range_offset_std_m, between(0.0, 1.0));
    visit("angle_noise_std_deg", self.angle_noise_std_deg, between(0.0, 1.0));
    visit("tilt_error_std_deg", self.tilt_error_std_deg, between(0.0, 1.0));
    visit("beam_exit_diameter_m", self.beam_exit_diameter_m, between(0.0, 0.1));
    visit("beam_divergence_rad", self.beam_divergence_rad, between(0.0, 0.01));
    visit("max_incidence_deg", self.max_incidence_deg, between(0.0, 90.0));
    visit("dropout_probability", self.dropout_probability, between(0.0, 1.0));
    visit("latency_s", self.latency_s, between(0.0, 60.0));
  }
};

template <>
struct SensorTraits<PanoramicScan> {
  struct Settings {
    PanoramicScannerSettings scanner;
  };
  static constexpr auto kSettings = &Settings::scanner;
  static constexpr SensorInfo kInfo = {.name = "scanner",
                                       .topic = "/scanner/points",
                                       .ros_type = "sensor_msgs/msg/PointCloud2",
                                       .summary = "terrestrial laser scanner, on command",
                                       .frame = "scanner",
                                       .trigger = SensorTrigger::kScanStation,
                                       .fault = {.unit = "m", .drift_per_s = 0.001, .outlier = 0.05}};

  /// Adds to the main reading, the ranges of all points.
  static void add_to_reading(PanoramicScan& scan, double offset_m) {
    for (ScannerPoint& point : scan.points) {
      const float range = std::hypot(point.x, point.y, point.z), scale = 1.0F + static_cast<float>(offset_m) / range;
      point.x *= scale, point.y *= scale, point.z *= scale;
    }
  }
};

}  // namespace patrol
