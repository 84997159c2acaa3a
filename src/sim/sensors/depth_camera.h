#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <vector>

#include <mujoco/mujoco.h>

#include "core/random.h"
#include "core/sensors/registry.h"
#include "core/settings.h"
#include "sim/as_built/sensor_errors.h"
#include "sim/body_poses.h"
#include "sim/dust.h"

namespace patrol::sim {

/// Pinhole camera without distortion; stereo cameras publish rectified images. The center of pixel (0, 0), top left, is
/// (0, 0).
struct PinholeLens {
  int width_px = 0, height_px = 0;
  double focal_px = 0.0;
  double cx_px() const { return 0.5 * (width_px - 1); }
  double cy_px() const { return 0.5 * (height_px - 1); }
};

PinholeLens make_lens(const DepthCameraSettings& settings);

/// Image of an ideal camera; [row][column] from the top left.
struct IdealDepthImage {
  std::vector<float> depth_m;       ///< depth along the optical axis; +Inf if nothing is in range
  std::vector<float> reflectivity;  ///< reflectivity, 0 ... 1; 0 if nothing is in range
};

/// Renderer of the world for the camera. The simulator has no renderer; the program provides one
/// (render/scene/depth_renderer.h).
class DepthImager {
 public:
  virtual ~DepthImager() = default;
  /// Renders an ideal image. `T_world_camera` has x along the optical axis and z up in the image.
  virtual void draw(const BodyPoses& bodies, const Pose3& T_world_camera, IdealDepthImage& image) = 0;
};

/// Factory of the imager of a view model, which must outlive it, for depths from `near_m` to `far_m`.
using DepthImagerFactory = std::function<std::unique_ptr<DepthImager>(const mjModel& view, const PinholeLens& lens,
                                                                      double near_m, double far_m)>;

/// Depth camera model: adds sensor errors to ideal images. Each error source has its own random stream, indexed by
/// frame and pixel. Calibration errors are the difference between the published intrinsics and those of the image, and
/// an error of the inverse depth.
///
/// Dust attenuates the pattern both ways, which reduces the range and increases the noise. Not modeled: errors
/// correlated between pixels, sunlight (it would drown the pattern), other cameras, and motion
/// within a frame.
class DepthCamera {
 public:
  DepthCamera(const DepthCameraSettings& settings, const DustSettings& dust, std::unique_ptr<DepthImager> imager,
              std::uint64_t seed, const DepthCameraErrors& errors = {});

  /// Takes frame number `tick`.
  DepthImage take(const BodyPoses& bodies, const Pose3& T_world_camera, Time now, std::uint64_t tick);

 private:
  void compute_inverse_depth();
  bool is_occluded_in_right_imager(int u, int v) const;
  bool is_at_edge(int u, int v) const;
  double incidence_cosine(int u, int v) const;
  bool is_visible(int u, int v) const;
  double inverse_depth(int u, int v) const { return inverse_depth_[index_of(u, v)]; }
  std::size_t index_of(int u, int v) const { return static_cast<std::size_t>(v * lens_.width_px + u); }

  DepthCameraSettings settings_;
  DustSettings dust_;
  DepthCameraErrors errors_;
  PinholeLens lens_;
  std::unique_ptr<DepthImager> imager_;
  RandomStream noise_, edge_, dropout_;
  IdealDepthImage ideal_;
  std::vector<double> inverse_depth_;  ///< [pixel], 1/m; 0 if nothing is in range
};

}  // namespace patrol::sim
