#include "score/pose/site_score.h"

#include <cmath>

#include <Eigen/Core>

#include "core/geometry/angles.h"
#include "core/geometry/linear_algebra.h"
#include "score/statistics.h"

namespace patrol::score {
namespace {

constexpr double kSpacing_m = 0.25;   // of the poses that the fit uses
constexpr double kMinExtent_m = 2.0;  // RMS distance of the path from its mean below which positions have no yaw

/// Poses at least `kSpacing_m` of true distance apart, so that standing does not outweigh driving.
std::vector<MatchedPose> spaced_poses(const Trajectory& T_map_body, const Trajectory& T_world_body) {
  std::vector<MatchedPose> spaced;
  for (const MatchedPose& pose : pair_poses(T_map_body, {}, T_world_body)) {
    const bool is_far =
        spaced.empty() || (pose.T_world_truth.position() - spaced.back().T_world_truth.position()).norm() >= kSpacing_m;
    if (is_far) spaced.push_back(pose);
  }
  return spaced;
}

}  // namespace

Pose2 fit_map_frame(const Trajectory& T_map_body, const Trajectory& T_world_body) {
  const std::vector<MatchedPose> poses = spaced_poses(T_map_body, T_world_body);
  const double count = static_cast<double>(poses.size());
  Eigen::Vector2d mean_map = Eigen::Vector2d::Zero(), mean_world = Eigen::Vector2d::Zero();
  for (const MatchedPose& pose : poses) {
    mean_map += pose.T_world_estimate.position() / count;
    mean_world += pose.T_world_truth.position() / count;
  }
  double dot = 0.0, cross = 0.0, extent_m2 = 0.0;
  for (const MatchedPose& pose : poses) {
    const Eigen::Vector2d a = pose.T_world_estimate.position() - mean_map;
    const Eigen::Vector2d b = pose.T_world_truth.position() - mean_world;
    dot += a.dot(b);
    cross += a.x() * b.y() - a.y() * b.x();
    extent_m2 += b.squaredNorm() / count;
  }
  if (poses.empty() || extent_m2 < kMinExtent_m * kMinExtent_m) return align_at_start(T_map_body, T_world_body);
  const Pose2 rotation{0.0, 0.0, std::atan2(cross, dot)};
  const Eigen::Vector2d position = mean_world - rotation * mean_map;
  return {position.x(), position.y(), rotation.yaw};
}

SiteScore site_score(const Trajectory& T_map_body, const MapInSite& map, const Trajectory& T_world_body) {
  SiteScore score{.pose = trajectory_error(map.place(T_map_body), {}, T_world_body),
                  .T_site_map = map.last().T_site_map,
                  .nees = {},
                  .num_registrations = map.num_registrations()};
  const Pose2 T_world_map = fit_map_frame(T_map_body, T_world_body);
  std::vector<double> errors_m;
  for (const MatchedPose& pose : spaced_poses(T_map_body, T_world_body)) {
    const Eigen::Vector2d p_map = pose.T_world_estimate.position();
    errors_m.push_back((score.T_site_map * p_map - T_world_map * p_map).norm());
  }
  score.position_error_m = root_mean_square(errors_m);
  const Eigen::Vector3d error(score.T_site_map.x - T_world_map.x, score.T_site_map.y - T_world_map.y,
                              wrap_angle(score.T_site_map.yaw - T_world_map.yaw));
  score.yaw_error_deg = to_deg(std::abs(error.z()));
  if (score.num_registrations > 0) score.nees = error.dot(solve_symmetric(map.last().covariance, error));
  return score;
}

}  // namespace patrol::score
