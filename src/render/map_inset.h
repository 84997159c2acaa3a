#pragma once

#include <memory>

#include "render/canvas.h"
#include "render/run_snapshot.h"

namespace patrol::render {

/// The map as it is being built, north up, in the lower right corner of a frame, with scan, paths, particles, and the robot
/// where it believes to be, over where it is.
class MapInset {
 public:
  void draw(Frame& frame, const RunSnapshot& snapshot);

 private:
  void lay_out(const Frame& frame, const RunSnapshot& snapshot);
  /// In the picture.
  Eigen::Vector2d pixel_of(const Eigen::Vector2d& p_world_m) const;

  std::shared_ptr<const OccupancyGrid> map_;  ///< that the picture is of
  Frame picture_;
  Eigen::Vector2d low_m_ = Eigen::Vector2d::Zero(), high_m_ = Eigen::Vector2d::Zero();  ///< shown, in world
  double px_per_m_ = 1.0;
};

}  // namespace patrol::render
