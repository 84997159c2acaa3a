#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <vector>

#include "core/sensors/sensor_traits.h"
#include "core/settings.h"
#include "core/time.h"

namespace patrol {

/// Frame of the infrared depth camera. Pixels are (column u, row v) from the top left. A pixel of depth d is the point
/// (d, -(u - cx) d / fx, -(v - cy) d / fy) in `depth_camera`, whose x axis is the optical axis.
struct DepthImage {
  Time stamp{};
  int width = 0;
  int height = 0;
  double fx_px = 0.0, fy_px = 0.0;
  double cx_px = 0.0, cy_px = 0.0;
  std::vector<std::uint16_t> depth_mm;  ///< [row][column], depth along the optical axis; 0 invalid
};

/// Infrared stereo camera with its own pattern projector, independent of ambient light. Defaults after Intel's
/// RealSense D435 (data sheet 337029: baseline 50 mm, 848 pixels wide). Depth error after [Keselman17]: sigma = z^2
/// subpixel / (focal length x baseline), here 0.08 px / (606 px x 0.05 m). The image has about every tenth pixel of
/// that camera in each direction. The dropout probabilities are assumptions.
struct DepthCameraSettings {
  bool enabled = false;                   ///< presence of the sensor; false: no messages
  double rate_hz = 5.0;                   ///< rate of the messages
  int width_px = 80;                      ///< width of the depth image
  int height_px = 60;                     ///< height of the depth image
  double fov_deg = 70.0;                  ///< horizontal field of view; pixels are square
  double range_min_m = 0.3;               ///< minimum depth along the optical axis
  double range_max_m = 8.0;               ///< maximum range of the sensor
  double depth_noise_std_per_m = 0.0026;  ///< standard deviation of the depth, divided by the squared depth
  double baseline_m = 0.05;      ///< distance between the left and the right imager; pixels occluded in the right
                                 ///< imager have no depth
  double edge_threshold = 0.15;  ///< edge threshold: second difference of the inverse depth between pixels, relative
                                 ///< to the inverse depth
  double edge_dropout_probability = 0.5;  ///< dropout probability of pixels at edges
  double dropout_probability = 0.01;      ///< dropout probability of any pixel
  double max_incidence_deg = 85.0;        ///< maximum angle of incidence; pixels beyond it are lost
  double max_range_10pct_m = 6.0;         ///< maximum range on a surface of 10 % reflectivity at normal incidence
  double latency_s = 0.05;                ///< delay from the measurement to the delivery of the message

  template <typename Self, typename Visitor>
  static void fields(Self& self, Visitor& visit) {
    visit("enabled", self.enabled);
    visit("rate_hz", self.rate_hz, between(0.1, 100.0));
    visit("width_px", self.width_px, between(4, 1280));
    visit("height_px", self.height_px, between(4, 1024));
    visit("fov_deg", self.fov_deg, between(5.0, 150.0));
    visit("range_min_m", self.range_min_m, between(0.05, 10.0));
    visit("range_max_m", self.range_max_m, between(0.1, 60.0));
    visit("depth_noise_std_per_m", self.depth_noise_std_per_m, between(0.0, 1.0));
    visit("baseline_m", self.baseline_m, between(0.0, 1.0));
    visit("edge_threshold", self.edge_threshold, at_least(0.001));
    visit("edge_dropout_probability", self.edge_dropout_probability, between(0.0, 1.0));
    visit("dropout_probability", self.dropout_probability, between(0.0, 1.0));
    visit("max_incidence_deg", self.max_incidence_deg, between(0.0, 90.0));
    visit("max_range_10pct_m", self.max_range_10pct_m, at_least(0.01));
    visit("latency_s", self.latency_s, between(0.0, 10.0));
  }
};

template <>
struct SensorTraits<DepthImage> {
  struct Settings {
    DepthCameraSettings depth_camera;
  };
  static constexpr auto kSettings = &Settings::depth_camera;
  static constexpr SensorInfo kInfo = {.name = "depth_camera",
                                       .topic = "/depth",
                                       .ros_type = "patrol_msgs/msg/DepthImage",
                                       .summary = "infrared stereo depth camera",
                                       .frame = "depth_camera",
                                       .timeout = SensorTimeout::kLidar,
                                       .fault = {.unit = "m", .drift_per_s = 0.02, .outlier = 0.5}};

  static void add_to_reading(DepthImage& image, double offset_m) {
    for (std::uint16_t& depth_mm : image.depth_mm) {
      if (depth_mm == 0) continue;
      depth_mm = static_cast<std::uint16_t>(std::clamp(std::lround(depth_mm + 1000.0 * offset_m), 0L, 65535L));
    }
  }
};

}  // namespace patrol
