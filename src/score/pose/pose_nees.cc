#include "score/pose/pose_nees.h"

#include <algorithm>
#include <optional>

#include "core/geometry/linear_algebra.h"

namespace patrol::score {
namespace {

constexpr double kChiSquared95 = 7.814728;  ///< 95 % point of chi squared with 3 degrees of freedom
constexpr double kMinStd = 1e-6;            ///< m and rad

bool is_singular(const Eigen::Matrix3d& covariance) {
  return !covariance.allFinite() || symmetric_eigen(covariance).values[0] <= kMinStd * kMinStd;
}

}  // namespace

PoseNees pose_nees(const Trajectory& T_map_body, const std::vector<Eigen::Matrix3d>& covariances,
                   const Pose2& T_world_map, const Trajectory& T_world_body) {
  PoseNees score;
  const Pose2 T_map_world = T_world_map.inverse();
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
    Eigen::Vector3d error = to_pose2(T_map_body[i].pose).vector() - (T_map_world * to_pose2(*truth)).vector();
    error.z() = wrap_angle(error.z());
    const double nees = error.dot(solve_symmetric(covariances[i], error));
    sum += nees;
    num_within += nees <= kChiSquared95 ? 1 : 0;
  }
  if (score.has_mean()) score.mean = sum / static_cast<double>(score.num_instants - score.num_singular);
  if (score.num_instants > 0)
    score.within_95 = static_cast<double>(num_within) / static_cast<double>(score.num_instants);
  return score;
}

}  // namespace patrol::score
