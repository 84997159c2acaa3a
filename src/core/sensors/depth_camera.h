#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <vector>

#include "core/sensors/sensor_traits.h"
#include "core/settings.h"
#include "core/time.h"

namespace patrol {

/// One frame of the infrared depth camera. A pixel (column u, row v, from the top left) of depth d shows the point
/// (d, -(u - cx) d / fx, -(v - cy) d / fy) in `depth_camera`, whose x axis is the optical axis.
struct DepthImage {
  Time stamp{};
  int width = 0;
  int height = 0;
  double fx_px = 0.0, fy_px = 0.0;
  double cx_px = 0.0, cy_px = 0.0;
  std::vector<std::uint16_t> depth_mm;  ///< [row][column], along the optical axis; 0 invalid
};

/// An infrared stereo camera that brings its own pattern of light: a dark tunnel is as good as a lit one. Defaults after
/// Intel's RealSense D435 (data sheet 337029: baseline 50 mm, 848 pixels wide); error by depth after Keselman et al.,
/// "Intel RealSense stereoscopic depth cameras", CVPR workshops 2017: sigma = z^2 subpixel / (focal length x baseline), here
/// 0.08 px / (606 px x 0.05 m). The picture given out is every tenth pixel or so of that. The shares of loss are assumptions.
struct DepthCameraSettings {
  bool enabled = false;
  double rate_hz = 5.0;
  int width_px = 80;
  int height_px = 60;
  double fov_deg = 70.0;           ///< across; pixels are square
  double range_min_m = 0.3;        ///< along the optical axis, as every depth
  double range_max_m = 8.0;
  double depth_noise_per_m = 0.0026;  ///< standard deviation over the depth's square
  double baseline_m = 0.05;        ///< from the imager to its fellow on the right: what that one cannot see has no depth
  double edge_step = 0.15;         ///< an edge: the inverse depth bends by this share of itself from pixel to pixel
  double edge_loss = 0.5;          ///< share of pixels lost along edges
  double dropout = 0.01;           ///< share of pixels lost for no reason
  double grazing_deg = 85.0;       ///< surfaces met flatter than this from their normal are lost
  double dark_range_m = 6.0;       ///< reach on a surface that throws back 10 % of the light, met squarely
  double latency_s = 0.05;

  template <typename Self, typename Visitor>
  static void fields(Self& self, Visitor& visit) {
    visit("enabled", self.enabled);
    visit("rate_hz", self.rate_hz, between(0.1, 100.0));
    visit("width_px", self.width_px, between(4, 1280));
    visit("height_px", self.height_px, between(4, 1024));
    visit("fov_deg", self.fov_deg, between(5.0, 150.0));
    visit("range_min_m", self.range_min_m, between(0.05, 10.0));
    visit("range_max_m", self.range_max_m, between(0.1, 60.0));
    visit("depth_noise_per_m", self.depth_noise_per_m, between(0.0, 1.0));
    visit("baseline_m", self.baseline_m, between(0.0, 1.0));
    visit("edge_step", self.edge_step, at_least(0.001));
    visit("edge_loss", self.edge_loss, between(0.0, 1.0));
    visit("dropout", self.dropout, between(0.0, 1.0));
    visit("grazing_deg", self.grazing_deg, between(0.0, 90.0));
    visit("dark_range_m", self.dark_range_m, at_least(0.01));
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
                                      .timeout = SensorTimeout::kLidar,
                                      .fault = {.unit = "m", .drift_per_s = 0.02, .spike = 0.5}};

  static void add_to_reading(DepthImage& image, double offset_m) {
    for (std::uint16_t& depth_mm : image.depth_mm) {
      if (depth_mm == 0) continue;
      depth_mm = static_cast<std::uint16_t>(std::clamp(std::lround(depth_mm + 1000.0 * offset_m), 0L, 65535L));
    }
  }
};

}  // namespace patrol
