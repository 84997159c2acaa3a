#pragma once

#include <Eigen/Core>

namespace patrol {

/// What an ideal lidar in the horizontal plane meets along one beam.
struct SurfaceReturn {
  Eigen::Vector2d direction;  ///< of the beam, unit, in world
  double range_m = 0.0;
  Eigen::Vector3d normal;     ///< of the surface, unit, in world, towards the lidar
};

}  // namespace patrol
