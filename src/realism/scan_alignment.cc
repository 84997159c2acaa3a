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

double corrected_range_m(float recorded_m, const ExpectedBeam& expected, const sim::LidarErrors& errors) {
  if (!expected.has_surface()) return static_cast<double>(recorded_m);
  return static_cast<double>(recorded_m) -
         errors.range_error_m(expected.range_m, expected.reflectivity, expected.cosine);
}

Eigen::Vector3d prior_of(const AlignmentSettings& settings) {
  const double variance_m2 = settings.distance_std_m * settings.distance_std_m;
  const double position = variance_m2 / (settings.position_std_m * settings.position_std_m);
  const double yaw_std_rad = settings.yaw_std_deg * kDegree;
  return {position, position, variance_m2 / (yaw_std_rad * yaw_std_rad)};
}

/// Change of the distance from the tangent plane with the correction of the pose.
Eigen::Vector3d jacobian_of(const Eigen::Vector3d& normal, const Eigen::Vector3d& arm) {
  return {normal.x(), normal.y(), arm.x() * normal.y() - arm.y() * normal.x()};
}

AlignmentSums sums_of(const Site& site, const PosedScan& posed, const BeamRules& rules,
                      const AlignmentSettings& settings, const sim::LidarErrors& errors) {
  AlignmentSums sums;
  const std::vector<ExpectedBeam> expected = expected_beams(site, posed, rules);
  const Eigen::Vector3d center = posed.T_site_lidar.front().position;
  for (std::size_t i = 0; i < expected.size(); ++i) {
    const double range_m = corrected_range_m(posed.scan.ranges_m[i], expected[i], errors);
    if (!expected[i].is_smooth || expected[i].is_glass || !std::isfinite(range_m) || range_m <= 0.0) continue;
    const Pose3 T_site_lidar = posed.pose_of(i);
    const Eigen::Vector3d along = T_site_lidar.rotation * posed.direction_at(posed.azimuth_rad(i));
    const Eigen::Vector3d& normal = expected[i].normal;
    const double distance_m = (range_m - expected[i].range_m) * normal.dot(along);
    const double weight = weight_of(distance_m, settings.max_distance_m);
    if (weight == 0.0) continue;
    const Eigen::Vector3d arm = T_site_lidar.position + range_m * along - center;
    const Eigen::Vector3d jacobian = jacobian_of(normal, arm);
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
                         const AlignmentSettings& settings, const sim::LidarErrors& errors) {
  ScanAlignment result{.posed = posed};
  const Eigen::Vector3d prior = prior_of(settings);
  for (int iteration = 0; iteration < settings.iterations; ++iteration) {
    const AlignmentSums sums = sums_of(site, result.posed, rules, settings, errors);
    result.num_beams = sums.num_beams;
    if (sums.num_beams < static_cast<std::size_t>(settings.min_beams)) return result;
    const Eigen::Matrix3d information = sums.information + Eigen::Matrix3d(prior.asDiagonal());
    const Eigen::LDLT<Eigen::Matrix3d> solver(information);
    result.absorbed_bias =
        std::clamp(sums.with_bias.dot(solver.solve(sums.with_bias)) / sums.bias_information, 0.0, 1.0);
    const Eigen::Vector3d step = -solver.solve(sums.gradient + prior.cwiseProduct(result.correction));
    result.correction += step;
    result.posed = corrected(posed, result.correction);
    if (step.head<2>().norm() < 1e-5 && std::abs(step.z()) < 1e-5) break;
  }
  return result;
}

SystematicErrorFit::SystematicErrorFit(const AlignmentSettings& settings) : settings_(settings) {
  const Eigen::Vector4d prior_std(0.2, 0.02, 0.1, 0.05);
  information_ = (settings.distance_std_m / prior_std.array()).square().matrix().asDiagonal();
  information_at_known_poses_ = information_;
}

void SystematicErrorFit::add(const ScanAlignment& aligned, const std::vector<ExpectedBeam>& expected,
                             const sim::LidarErrors& errors) {
  const PosedScan& posed = aligned.posed;
  const Eigen::Vector3d center = posed.T_site_lidar.front().position, prior = prior_of(settings_);
  Eigen::Matrix3d pose_information = prior.asDiagonal();
  Eigen::Vector3d pose_gradient = prior.cwiseProduct(aligned.correction);
  Eigen::Matrix4d information = Eigen::Matrix4d::Zero();
  Eigen::Matrix<double, 3, 4> mixed = Eigen::Matrix<double, 3, 4>::Zero();
  Eigen::Vector4d gradient = Eigen::Vector4d::Zero();
  for (std::size_t i = 0; i < expected.size(); ++i) {
    const ExpectedBeam& beam = expected[i];
    const double range_m = corrected_range_m(posed.scan.ranges_m[i], beam, errors);
    if (!beam.is_smooth || beam.is_glass || !std::isfinite(range_m) || range_m <= 0.0) continue;
    const Pose3 T_site_lidar = posed.pose_of(i);
    const Eigen::Vector3d along = T_site_lidar.rotation * posed.direction_at(posed.azimuth_rad(i));
    const double effect = beam.normal.dot(along), distance_m = (range_m - beam.range_m) * effect;
    const double weight = weight_of(distance_m, settings_.max_distance_m);
    const Eigen::Vector3d pose = jacobian_of(beam.normal, T_site_lidar.position + range_m * along - center);
    const double darkness = std::log(0.5 / std::min(1.0, beam.reflectivity)) / std::log(5.0);
    const Eigen::Vector4d error = -effect * Eigen::Vector4d(1.0, beam.range_m, 1.0 - beam.cosine, darkness);
    pose_information += weight * pose * pose.transpose();
    pose_gradient += weight * distance_m * pose;
    mixed += weight * pose * error.transpose();
    information += weight * error * error.transpose();
    gradient += weight * distance_m * error;
  }
  const Eigen::LDLT<Eigen::Matrix3d> solver(pose_information);
  information_at_known_poses_ += information;
  information_ += information - mixed.transpose() * solver.solve(mixed);
  gradient_ += gradient - mixed.transpose() * solver.solve(pose_gradient);
}

sim::LidarErrors SystematicErrorFit::improved(const sim::LidarErrors& errors) const {
  const Eigen::Vector4d step = -information_.ldlt().solve(gradient_);
  sim::LidarErrors result = errors;
  result.range_offset_m += step[0];
  result.range_scale += step[1];
  result.incidence_m += step[2];
  result.reflectivity_m += step[3];
  return result;
}

std::array<double, 4> SystematicErrorFit::interval_factors() const {
  const Eigen::Matrix4d at_aligned = information_.inverse(), at_known = information_at_known_poses_.inverse();
  std::array<double, 4> factors{};
  for (std::size_t j = 0; j < factors.size(); ++j) {
    const auto k = static_cast<Eigen::Index>(j);
    factors[j] = std::sqrt(std::max(1.0, at_aligned(k, k) / at_known(k, k)));
  }
  return factors;
}

}  // namespace patrol::realism
