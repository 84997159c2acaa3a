#include "localize/amcl/pose_refinement.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include <Eigen/LU>

#include "core/geometry/linear_algebra.h"
#include "core/geometry/principal_axes.h"

namespace patrol::localize {
namespace {

constexpr double kStepTolerance_m = 2e-4;
constexpr double kStepTolerance_rad = 1e-5;

double squared(double value) { return value * value; }

/// Residual of a point relative to its line.
struct Residual {
  double distance_m;
  double weight;           ///< inverse variance, reduced for outliers
  Eigen::Vector2d normal;  ///< normal of the line, in map
  double d_by_yaw;         ///< derivative of the distance with respect to yaw, m
};

/// Residuals of the points near a surface.
std::vector<Residual> residuals_at(const LineField& lines, const std::vector<slam::MatchPoint>& points,
                                   const Pose2& T_map_body, const PoseRefinementSettings& settings) {
  std::vector<Residual> residuals;
  residuals.reserve(points.size());
  const Eigen::Matrix2d R = Eigen::Rotation2Dd(T_map_body.yaw).toRotationMatrix();
  for (const slam::MatchPoint& point : points) {
    const Eigen::Vector2d arm = R * point.p_body;
    const Eigen::Vector2d p_map = T_map_body.position() + arm;
    const SurfaceLine* line = lines.find(p_map);
    if (!line) continue;
    const Eigen::Vector2d& n = line->normal_map;
    const double distance_m = n.dot(p_map - line->point_map);
    const double variance =
        squared(settings.point_std_m) + squared(settings.point_angle_std_rad * point.range_m) + line->normal_var_m2;
    // Cauchy: weight = 1 / (1 + (r / kernel)^2).
    const double weight = squared(line->linearity) / (variance * (1.0 + squared(distance_m / settings.kernel_m)));
    residuals.push_back({distance_m, weight, n, n.y() * arm.x() - n.x() * arm.y()});
  }
  return residuals;
}

struct NormalEquations {
  Eigen::Matrix3d H = Eigen::Matrix3d::Zero();
  Eigen::Vector3d b = Eigen::Vector3d::Zero();
};

/// Unit vector along which the lines constrain the position least.
Eigen::Vector2d weak_axis(const std::vector<Residual>& residuals) {
  Eigen::Matrix2d sum = Eigen::Matrix2d::Zero();
  for (const Residual& residual : residuals) sum += residual.weight * residual.normal * residual.normal.transpose();
  return PrincipalAxes::along(principal_axes(sum).small_direction_rad());
}

NormalEquations equations_of(const std::vector<Residual>& residuals, const PoseRefinementSettings& settings) {
  NormalEquations sum;
  const Eigen::Vector2d u = weak_axis(residuals), v(-u.y(), u.x());
  for (const Residual& residual : residuals) {
    const double incidence_sine = residual.normal.dot(u);
    Eigen::Vector3d J;
    J << (std::abs(incidence_sine) > settings.min_incidence_sine ? residual.normal
                                                                 : Eigen::Vector2d(residual.normal.dot(v) * v)),
        residual.d_by_yaw;
    sum.H += settings.likelihood_tempering * residual.weight * J * J.transpose();
    sum.b += settings.likelihood_tempering * residual.weight * residual.distance_m * J;
  }
  return sum;
}

double fraction_within(const std::vector<Residual>& residuals, double tolerance_m, std::size_t num_points) {
  const auto count = std::count_if(residuals.begin(), residuals.end(), [&](const Residual& residual) {
    return std::abs(residual.distance_m) < tolerance_m;
  });
  return num_points > 0 ? static_cast<double>(count) / static_cast<double>(num_points) : 0.0;
}

}  // namespace

RefinedPose refine_pose(const LineField& lines, const LevelScan& scan, const slam::PoseGaussian& prior,
                        const Pose2& T_map_start, const PoseRefinementSettings& settings) {
  RefinedPose refined{.posterior = prior};
  const std::vector<slam::MatchPoint> points =
      slam::downsample_scan(scan, settings.point_spacing_m, settings.max_points);
  refined.num_points = static_cast<int>(points.size());
  const Eigen::Matrix3d prior_information = prior.covariance.inverse();
  Pose2 pose = T_map_start;
  NormalEquations sum;
  for (int iteration = 0; iteration < settings.max_iterations; ++iteration) {
    const std::vector<Residual> residuals = residuals_at(lines, points, pose, settings);
    refined.inlier_ratio = fraction_within(residuals, 2.0 * settings.kernel_m, points.size());
    if (refined.inlier_ratio < settings.min_inlier_ratio) return refined;

    sum = equations_of(residuals, settings);
    const Eigen::Vector3d step = -solve_symmetric(Eigen::Matrix3d(sum.H + prior_information),
                                                  sum.b + prior_information * prior.residual_to_mean(pose));
    if (!step.allFinite()) return refined;
    pose = slam::perturbed(pose, step);
    if (step.head<2>().norm() < kStepTolerance_m && std::abs(step.z()) < kStepTolerance_rad) break;
  }
  refined.is_matched = true;
  refined.information = sum.H;
  Eigen::Matrix3d covariance = (refined.information + prior_information).inverse();
  covariance.diagonal() +=
      Eigen::Vector3d(squared(settings.map_std_m), squared(settings.map_std_m), squared(settings.map_std_rad));
  refined.posterior = {.mean = pose, .covariance = 0.5 * (covariance + covariance.transpose())};
  return refined;
}

ScanProposal::ScanProposal(const RefinedPose& refined, const Eigen::Matrix3d& spread)
    : matched_(refined.posterior.mean) {
  const Eigen::Matrix3d covariance = (spread.inverse() + refined.information).inverse();
  gain_ = covariance * refined.information;
  root_ = cholesky_factor(Eigen::Matrix3d(0.5 * (covariance + covariance.transpose())));
}

Pose2 ScanProposal::sample(const Pose2& particle, const Eigen::Vector3d& unit) const {
  const Eigen::Vector3d offset = slam::PoseGaussian{.mean = particle}.residual_to_mean(matched_);
  return slam::perturbed(particle, gain_ * offset + root_ * unit);
}

}  // namespace patrol::localize
