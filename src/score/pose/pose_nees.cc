#include "score/pose/pose_nees.h"

#include <algorithm>
#include <optional>

#include <Eigen/Geometry>

#include "core/chi_squared.h"
#include "core/geometry/linear_algebra.h"

namespace patrol::score {
namespace {

constexpr double kMinStd = 1e-6;  ///< m and rad

bool is_singular(const Eigen::Matrix3d& covariance) {
  return !covariance.allFinite() || symmetric_eigen(covariance).values[0] <= kMinStd * kMinStd;
}

/// Covariance of x, y, yaw of the body in site, of independent errors in map and of the registration.
Eigen::Matrix3d covariance_in_site(const Pose2& T_map_body, const Eigen::Matrix3d& covariance_in_map,
                                   const SiteRegistration& registration) {
  Eigen::Matrix3d by_pose = Eigen::Matrix3d::Identity(), by_map = Eigen::Matrix3d::Identity();
  const Eigen::Rotation2Dd R_site_map(registration.T_site_map.yaw);
  by_pose.topLeftCorner<2, 2>() = R_site_map.toRotationMatrix();
  const Eigen::Vector2d lever = R_site_map * T_map_body.position();
  by_map.col(2).head<2>() << -lever.y(), lever.x();
  return by_pose * covariance_in_map * by_pose.transpose() + by_map * registration.covariance * by_map.transpose();
}

}  // namespace

PoseNees pose_nees(const Trajectory& T_map_body, const std::vector<Eigen::Matrix3d>& covariances, const MapInSite& map,
                   const Trajectory& T_world_body) {
  PoseNees score;
  double sum = 0.0;
  std::size_t num_within = 0;
  for (std::size_t i = 0; i < std::min(T_map_body.size(), covariances.size()); ++i) {
    const std::optional<Pose3> truth = pose_at(T_world_body, T_map_body[i].stamp);
    if (!truth) continue;
    ++score.num_instants;
    if (is_singular(covariances[i])) {
      ++score.num_singular;
      continue;
    }
    const SiteRegistration& registration = map.at(T_map_body[i].stamp);
    const Pose2 estimate = to_pose2(T_map_body[i].pose);
    Eigen::Vector3d error = (registration.T_site_map * estimate).vector() - to_pose2(*truth).vector();
    error.z() = wrap_angle(error.z());
    const Eigen::Matrix3d covariance = covariance_in_site(estimate, covariances[i], registration);
    const double nees = error.dot(solve_symmetric(covariance, error));
    sum += nees;
    num_within += nees <= kChiSquared95Of3 ? 1 : 0;
  }
  if (score.has_mean()) score.mean = sum / static_cast<double>(score.num_instants - score.num_singular);
  if (score.num_instants > 0)
    score.within_95 = static_cast<double>(num_within) / static_cast<double>(score.num_instants);
  return score;
}

}  // namespace patrol::score
