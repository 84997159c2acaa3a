#include "slam/graph/degeneracy.h"

#include "core/geometry/linear_algebra.h"

namespace patrol::slam {

std::optional<Eigen::Vector2d> degenerate_direction(const Eigen::Matrix3d& information, double min_eigenvalue_ratio) {
  if (information(2, 2) <= 0.0) return std::nullopt;
  // Information of the position with free heading (Schur complement).
  const Eigen::Vector2d with_yaw = information.topRightCorner<2, 1>();
  const Eigen::Matrix2d position =
      information.topLeftCorner<2, 2>() - with_yaw * with_yaw.transpose() / information(2, 2);
  const SymmetricEigen<2> axes = symmetric_eigen(position);  // the smaller eigenvalue first
  if (axes.values[0] >= min_eigenvalue_ratio * axes.values[1]) return std::nullopt;
  return Eigen::Vector2d(axes.vectors.col(0));
}

Eigen::Vector3d determined_offset(const Eigen::Vector3d& offset, const Eigen::Matrix3d& information,
                                  double min_eigenvalue_ratio) {
  const auto degenerate = degenerate_direction(information, min_eigenvalue_ratio);
  if (!degenerate) return offset;
  Eigen::Vector3d determined = offset;
  determined.head<2>() -= degenerate->dot(offset.head<2>()) * *degenerate;
  return determined;
}

Eigen::Matrix3d project_out(const Eigen::Matrix3d& information, const Eigen::Vector2d& direction) {
  Eigen::Matrix3d rest = Eigen::Matrix3d::Identity();
  rest.topLeftCorner<2, 2>() -= direction * direction.transpose();
  return rest * information * rest;
}

}  // namespace patrol::slam
