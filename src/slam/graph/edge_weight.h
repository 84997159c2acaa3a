#pragma once

#include <Eigen/LU>

namespace patrol::slam {

/// Information of an edge that comes of a match: the match's, but never more than `std_m` and `std_rad` leave, which it errs by however many points it
/// has; and ten metres and ten radians where it says nothing. Of x, y, yaw in the edge's `from`, as `match_information` is.
inline Eigen::Matrix3d edge_information(const Eigen::Matrix3d& match_information, double std_m, double std_rad) {
  const Eigen::Matrix3d loose = Eigen::Vector3d(1e-2, 1e-2, 1e-2).asDiagonal();
  const Eigen::Matrix3d systematic = Eigen::Vector3d(std_m * std_m, std_m * std_m, std_rad * std_rad).asDiagonal();
  const Eigen::Matrix3d information = ((match_information + loose).inverse() + systematic).inverse();
  return 0.5 * (information + information.transpose());
}

}  // namespace patrol::slam
