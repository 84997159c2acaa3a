#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <vector>

#include <mujoco/mujoco.h>

#include "core/messages.h"
#include "core/random.h"
#include "core/settings.h"
#include "sim/dust.h"

namespace patrol::sim {

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

/// A pinhole; what a stereo camera gives out is free of distortion. Pixel (0, 0) has its middle at (0, 0), top left.
struct PinholeLens {
  int width_px = 0, height_px = 0;
  double focal_px = 0.0;
  double cx_px() const { return 0.5 * (width_px - 1); }
  double cy_px() const { return 0.5 * (height_px - 1); }
};

PinholeLens lens_of(const DepthCameraSettings& settings);

/// What a perfect camera would see; [row][column] from the top left.
struct SurfaceImage {
  std::vector<float> depth_m;       ///< along the optical axis; +Inf where there is nothing within range
  std::vector<float> reflectivity;  ///< 0 ... 1; 0 where there is nothing
};

/// Draws the world for the camera. The twin holds no renderer: the program brings one (render/depth_renderer.h).
class DepthImager {
 public:
  virtual ~DepthImager() = default;
  /// `data` is of the view model or of the physics model, whose bodies are the same. `T_world_camera` has x along the optical
  /// axis and z up in the picture.
  virtual void draw(const mjData& data, const Pose3& T_world_camera, SurfaceImage& image) = 0;
};

/// Makes the imager of a view model, which must outlive it, for things from `near_m` to `far_m`.
using DepthImagerFactory =
    std::function<std::unique_ptr<DepthImager>(const mjModel& view, const PinholeLens& lens, double near_m, double far_m)>;

/// Turns perfect pictures into those of the camera. Every imperfection has its own random stream, addressed by frame and pixel.
///
/// Dust weakens the pattern there and back: less reach, and noise that grows as the contrast falls. Not modelled: errors
/// that neighbouring pixels share, a wrong calibration, sunlight (it would drown the pattern), other cameras, and motion
/// within a frame.
class DepthCamera {
 public:
  DepthCamera(const DepthCameraSettings& settings, const DustSettings& dust, std::unique_ptr<DepthImager> imager, std::uint64_t seed);

  /// Frame number `tick`.
  DepthImage take(const mjData& data, const Pose3& T_world_camera, Time now, std::uint64_t tick);

 private:
  void measure_disparity();
  bool is_hidden_from_fellow(int u, int v) const;
  bool is_at_edge(int u, int v) const;
  double incidence_cosine(int u, int v) const;
  bool is_visible(int u, int v) const;
  double inverse_depth(int u, int v) const { return inverse_depth_[index_of(u, v)]; }
  std::size_t index_of(int u, int v) const { return static_cast<std::size_t>(v * lens_.width_px + u); }

  DepthCameraSettings settings_;
  DustSettings dust_;
  PinholeLens lens_;
  std::unique_ptr<DepthImager> imager_;
  RandomStream noise_, edge_, dropout_;
  SurfaceImage seen_;
  std::vector<double> inverse_depth_;  ///< [pixel], 1/m; 0 for nothing
};

}  // namespace patrol::sim
