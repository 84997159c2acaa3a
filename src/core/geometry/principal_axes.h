#pragma once

#include <cmath>
#include <numbers>

#include <Eigen/Core>

namespace patrol {

/// Principal axes of a symmetric 2 x 2 matrix, for example of a covariance or an information matrix.
struct PrincipalAxes {
  double large = 0.0;  ///< larger eigenvalue
  double small = 0.0;
  double large_direction_rad = 0.0;  ///< direction of the eigenvector of `large`, in [-pi/2, pi/2]

  double small_direction_rad() const {
    return std::remainder(large_direction_rad + std::numbers::pi / 2.0, std::numbers::pi);
  }
  static Eigen::Vector2d along(double direction_rad) { return {std::cos(direction_rad), std::sin(direction_rad)}; }
};

inline PrincipalAxes principal_axes(const Eigen::Matrix2d& matrix) {
  const double middle = 0.5 * (matrix(0, 0) + matrix(1, 1)), half = 0.5 * (matrix(0, 0) - matrix(1, 1));
  const double reach = std::hypot(half, matrix(0, 1));
  const double large = middle + reach;
  // Compute the smaller eigenvalue from the determinant: middle - reach cancels when it is much smaller than the other.
  const double determinant = matrix(0, 0) * matrix(1, 1) - matrix(0, 1) * matrix(0, 1);
  return {.large = large,
          .small = middle > 0.0 && large > 0.0 ? determinant / large : middle - reach,
          .large_direction_rad = 0.5 * std::atan2(matrix(0, 1), half)};
}

}  // namespace patrol
