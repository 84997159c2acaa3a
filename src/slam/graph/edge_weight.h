#pragma once

#include <Eigen/LU>

namespace patrol::slam {

/// Converts the information of a match to that of an edge. The systematic error `std_m`, `std_rad` bounds it from
/// above, however many points the match has. Directions without information get 10 m and 10 rad. Both matrices are for
/// x, y, yaw in the frame of the edge's `from`.
inline Eigen::Matrix3d edge_information(const Eigen::Matrix3d& match_information, double std_m, double std_rad) {
  const Eigen::Matrix3d loose = Eigen::Vector3d(1e-2, 1e-2, 1e-2).asDiagonal();
  const Eigen::Matrix3d systematic = Eigen::Vector3d(std_m * std_m, std_m * std_m, std_rad * std_rad).asDiagonal();
  const Eigen::Matrix3d information = ((match_information + loose).inverse() + systematic).inverse();
  return 0.5 * (information + information.transpose());
}

}  // namespace patrol::slam
