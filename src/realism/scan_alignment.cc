#include "realism/scan_alignment.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include <Eigen/Dense>

#include "core/geometry/angles.h"
#include "realism/expected_scan.h"

namespace patrol::realism {
namespace {

/// Normal equations of the correction, and of a common range error beside it.
struct AlignmentSums {
  Eigen::Matrix3d information = Eigen::Matrix3d::Zero();
  Eigen::Vector3d gradient = Eigen::Vector3d::Zero();
  Eigen::Vector3d with_bias = Eigen::Vector3d::Zero();  ///< J^T W c, with c the effect of a unit range error
  double bias_information = 0.0;                        ///< c^T W c
  std::size_t num_beams = 0;
};

/// Tukey's biweight.
double weight_of(double distance_m, double max_distance_m) {
  const double ratio = distance_m / max_distance_m;
  const double rest = 1.0 - ratio * ratio;
  return rest > 0.0 ? rest * rest : 0.0;
}

AlignmentSums sums_of(const Site& site, const PosedScan& posed, const BeamRules& rules,
                      const AlignmentSettings& settings, double bias_m) {
  AlignmentSums sums;
  const std::vector<ExpectedBeam> expected = expected_beams(site, posed, rules);
  const Eigen::Vector3d center = posed.T_site_lidar.front().position;
  for (std::size_t i = 0; i < expected.size(); ++i) {
    const double range_m = static_cast<double>(posed.scan.ranges_m[i]) - bias_m;
    if (!expected[i].is_smooth || expected[i].is_glass || !std::isfinite(range_m) || range_m <= 0.0) continue;
    const Pose3 T_site_lidar = posed.pose_of(i);
    const Eigen::Vector3d along = T_site_lidar.rotation * direction_of(posed.azimuth_rad(i));
    const Eigen::Vector3d& normal = expected[i].normal;
    const double distance_m = (range_m - expected[i].range_m) * normal.dot(along);
    const double weight = weight_of(distance_m, settings.max_distance_m);
    if (weight == 0.0) continue;
    const Eigen::Vector3d arm = T_site_lidar.position + range_m * along - center;
    const Eigen::Vector3d jacobian(normal.x(), normal.y(), arm.x() * normal.y() - arm.y() * normal.x());
    const double bias_effect = normal.dot(along);
    sums.information += weight * jacobian * jacobian.transpose();
    sums.gradient += weight * distance_m * jacobian;
    sums.with_bias += weight * bias_effect * jacobian;
    sums.bias_information += weight * bias_effect * bias_effect;
    ++sums.num_beams;
  }
  return sums;
}

}  // namespace

ScanAlignment align_scan(const Site& site, const PosedScan& posed, const BeamRules& rules,
                         const AlignmentSettings& settings, double bias_m) {
  ScanAlignment result{.posed = posed};
  const double variance_m2 = settings.distance_std_m * settings.distance_std_m;
  const double yaw_std_rad = settings.yaw_std_deg * kDegree;
  const Eigen::Vector3d prior(variance_m2 / (settings.position_std_m * settings.position_std_m),
                              variance_m2 / (settings.position_std_m * settings.position_std_m),
                              variance_m2 / (yaw_std_rad * yaw_std_rad));
  for (int iteration = 0; iteration < settings.iterations; ++iteration) {
    const AlignmentSums sums = sums_of(site, result.posed, rules, settings, bias_m);
    result.num_beams = sums.num_beams;
    if (sums.num_beams < static_cast<std::size_t>(settings.min_beams)) return result;
    const Eigen::Matrix3d information = sums.information + Eigen::Matrix3d(prior.asDiagonal());
    const Eigen::LDLT<Eigen::Matrix3d> solver(information);
    result.absorbed_bias = std::clamp(sums.with_bias.dot(solver.solve(sums.with_bias)) / sums.bias_information, 0.0, 1.0);
    const Eigen::Vector3d step = -solver.solve(sums.gradient + prior.cwiseProduct(result.correction));
    result.correction += step;
    result.posed = corrected(posed, result.correction);
    if (step.head<2>().norm() < 1e-5 && std::abs(step.z()) < 1e-5) break;
  }
  return result;
}

}  // namespace patrol::realism
