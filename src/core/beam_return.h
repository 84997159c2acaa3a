#pragma once

#include <Eigen/Core>

namespace patrol {

/// Return of an ideal horizontal 2D lidar along one beam.
struct BeamReturn {
  Eigen::Vector2d direction;  ///< unit vector of the beam, in world
  double range_m = 0.0;
  Eigen::Vector3d normal;  ///< unit normal of the surface, in world, pointing to the lidar
};

}  // namespace patrol
