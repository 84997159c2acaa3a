#include "score/water_score.h"

#include <set>

#include <Eigen/Cholesky>

#include "core/chi_squared.h"
#include "core/geometry/linear_algebra.h"

namespace patrol::score {
namespace {

std::optional<std::size_t> nearest_body(const std::vector<WaterGroundTruth>& bodies, const Eigen::Vector3d& p_world_m,
                                        double max_distance_m) {
  std::optional<std::size_t> nearest;
  for (std::size_t i = 0; i < bodies.size(); ++i) {
    const double distance_m = (bodies[i].p_world_m - p_world_m).norm();
    if (distance_m > max_distance_m) continue;
    nearest = i;
    max_distance_m = distance_m;
  }
  return nearest;
}

}  // namespace

WaterScore water_score(const std::vector<WaterResult>& results, const std::vector<WaterGroundTruth>& bodies,
                       const MapInSite& map, const Trajectory& T_world_body, const Eigen::Vector3d& p_body_antenna,
                       double max_distance_m) {
  WaterScore score{.bodies = static_cast<int>(bodies.size()), .findings = {}};
  std::set<std::size_t> found;
  for (const WaterResult& result : results) {
    if (result.soundings > 0) ++score.stations;
    const std::optional<Pose3> T_world_body_at_stamp = pose_at(T_world_body, result.stamp);
    if (!result.is_found || !T_world_body_at_stamp) continue;
    const Pose3 T_world_map_at_height = to_pose3(map.at(result.stamp).T_site_map, T_world_body_at_stamp->position.z());
    const Eigen::Vector3d p_world_m = T_world_map_at_height * result.p_map;
    WaterFinding finding{.station = result.station, .body = nearest_body(bodies, p_world_m, max_distance_m)};
    if (!finding.body) {
      ++score.false_alarms;
    } else {
      found.insert(*finding.body);
      const WaterGroundTruth& body = bodies[*finding.body];
      const Eigen::Vector3d error_m = p_world_m - body.p_world_m,
                            offset_m = body.p_world_m - *T_world_body_at_stamp * p_body_antenna;
      const Eigen::Matrix3d R = T_world_map_at_height.rotation.toRotationMatrix();
      const Eigen::Matrix3d covariance_m2 = R * result.covariance_m2 * R.transpose();
      finding.position_error_m = error_m.norm();
      finding.ahead_error_m = error_m.dot(offset_m.normalized());
      finding.radius_error_m = result.radius_m - body.radius_m;
      finding.distance_in_interval =
          offset_m.norm() >= result.distance_low_m && offset_m.norm() <= result.distance_high_m;
      finding.radius_in_interval = body.radius_m >= result.radius_low_m && body.radius_m <= result.radius_high_m;
      finding.position_in_ellipsoid = error_m.dot(solve_symmetric(covariance_m2, error_m)) <= kChiSquared95Of3;
    }
    score.findings.push_back(finding);
  }
  score.found = static_cast<int>(found.size());
  score.missed = score.stations > 0 ? score.bodies - score.found : 0;
  return score;
}

}  // namespace patrol::score
