#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include <Eigen/Core>

#include "render/camera.h"
#include "render/canvas.h"
#include "render/frame.h"

namespace patrol::render {

/// Draws lines and dots that lie in the world on a finished frame: smaller with distance, hidden behind what
/// stands before them. Cheaper than making them part of the scene, and their edges are smooth.
class WorldInk {
 public:
  /// `depth` as in Offscreen::read_depth. All three must outlive this.
  WorldInk(Frame& frame, const std::vector<float>& depth, const Projector& projector);

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
      coverage_;  ///< of the brush being laid on: strokes of one line do not add up where they meet
  int top_ = 0, bottom_ = -1;  ///< rows that have any
};

}  // namespace patrol::render
