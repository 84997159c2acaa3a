#pragma once

#include <Eigen/Core>

namespace patrol {

/// A surveyed ultra-wideband anchor; the frame of `p_m` is said where it is used.
struct UwbAnchor {
  int number = 0;
  Eigen::Vector3d p_m = Eigen::Vector3d::Zero();
};

}  // namespace patrol
