#include "app/check/circle_fit.h"

#include <cmath>

#include "core/geometry/linear_algebra.h"

namespace patrol::app {

Circle fit_circle(const std::vector<Eigen::Vector2d>& points_m) {
  Eigen::Matrix3d normal = Eigen::Matrix3d::Zero();
  Eigen::Vector3d right = Eigen::Vector3d::Zero();
  for (const Eigen::Vector2d& p_m : points_m) {
    const Eigen::Vector3d row(2.0 * p_m.x(), 2.0 * p_m.y(), 1.0);
    normal += row * row.transpose();
    right += row * p_m.squaredNorm();
  }
  const Eigen::Vector3d solution = solve_symmetric(normal, right);
  const Eigen::Vector2d center_m = solution.head<2>();
  return {.center_m = center_m, .radius_m = std::sqrt(solution.z() + center_m.squaredNorm())};
}

}  // namespace patrol::app
