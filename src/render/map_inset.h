#pragma once

#include <memory>

#include "render/canvas.h"
#include "render/run_snapshot.h"

namespace patrol::render {

/// Current map, north up, in the lower right corner of a frame, with scan, paths, particles, and the estimated robot
/// pose over the true one.
class MapInset {
 public:
  /// Draws the inset. No effect before the first map.
  void draw(Frame& frame, const RunSnapshot& snapshot);

 private:
  void update_picture(const Frame& frame, const RunSnapshot& snapshot);
  /// Pixel of a world point in the inset.
  Eigen::Vector2d pixel_of(const Eigen::Vector2d& p_world_m) const;

  std::shared_ptr<const OccupancyGrid> map_;  ///< map that `picture_` was drawn from
  Frame picture_;
  Eigen::Vector2d low_m_ = Eigen::Vector2d::Zero(), high_m_ = Eigen::Vector2d::Zero();  ///< displayed area in world
  double px_per_m_ = 1.0;
};

}  // namespace patrol::render
