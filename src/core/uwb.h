#pragma once

#include <Eigen/Core>

namespace patrol {

struct UwbAnchor {
  int number = 0;
  Eigen::Vector3d p_m = Eigen::Vector3d::Zero();  ///< antenna, in the frame that the text says (site, map)
};

}  // namespace patrol
