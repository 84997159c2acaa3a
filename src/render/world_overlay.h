#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include <Eigen/Core>

#include "render/canvas.h"
#include "render/scene/camera.h"
#include "render/scene/frame.h"

namespace patrol::render {

/// Draws lines and dots at world positions on a finished frame, scaled by distance and occluded by objects in front of
/// them. Cheaper than adding them to the scene, with anti-aliased edges.
class WorldOverlay {
 public:
  /// `depth` as in Offscreen::read_depth. All three arguments must outlive this object.
  WorldOverlay(Frame& frame, const std::vector<float>& depth, const Projector& projector);

  /// Draws line segments of constant width in world, at least 1.6 pixels at a frame height of 720.
  void polyline(std::span<const Eigen::Vector3d> points_m, double width_m, const Brush& brush);
  void dots(std::span<const Eigen::Vector3d> points_m, double radius_m, const Brush& brush);

 private:
  struct Stroke;
  void stroke(const Eigen::Vector3d& from_in_camera, const Eigen::Vector3d& to_in_camera, double width_m);
  void cover(const Stroke& stroke);
  bool is_hidden(std::size_t pixel, double distance_m) const;
  void blend_in(const Brush& brush);

  Frame& frame_;
  const std::vector<float>& depth_;
  const Projector& projector_;
  std::vector<std::uint8_t>
      coverage_;  ///< coverage of the current color, 0 ... 255; overlapping segments of one line do not add up
  int top_ = 0, bottom_ = -1;  ///< rows with coverage
};

}  // namespace patrol::render
