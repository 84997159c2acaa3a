#include "slam/rigid_motion.h"

#include <cmath>
#include <cstddef>

namespace patrol::slam {

Pose2 fit_rigid_motion(const std::vector<Eigen::Vector2d>& points_target,
                       const std::vector<Eigen::Vector2d>& points_source) {
  const auto count = static_cast<double>(points_target.size());
  Eigen::Vector2d mu_p = Eigen::Vector2d::Zero(), mu_q = Eigen::Vector2d::Zero();  // eq. 10
  for (std::size_t i = 0; i < points_target.size(); ++i) {
    mu_p += points_target[i] / count;
    mu_q += points_source[i] / count;
  }
  // The minimum of eq. 11 is at sum p' x R q' = 0. The source uses Gauss-Newton; in the plane it is one arc tangent.
  double dot = 0.0, cross = 0.0;
  for (std::size_t i = 0; i < points_target.size(); ++i) {
    const Eigen::Vector2d p = points_target[i] - mu_p, q = points_source[i] - mu_q;
    dot += q.dot(p);
    cross += q.x() * p.y() - q.y() * p.x();
  }
  const double yaw = std::atan2(cross, dot);
  const Eigen::Vector2d t = mu_p - Pose2{0.0, 0.0, yaw} * mu_q;  // eq. 12
  return {t.x(), t.y(), yaw};
}

}  // namespace patrol::slam
