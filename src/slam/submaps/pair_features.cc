#include "slam/submaps/pair_features.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>

#include "core/geometry/linear_algebra.h"

namespace patrol::slam {
namespace {

constexpr double kMaxDeviations = 30.0;
constexpr double kMinObservedFraction = 0.1;

/// Mahalanobis distance. A direction of zero variance counts as one with a standard deviation of 1 um or 1 urad.
template <int N>
double mahalanobis(const Eigen::Matrix<double, N, 1>& offset, const Eigen::Matrix<double, N, N>& covariance) {
  const Eigen::Matrix<double, N, N> regular = covariance + 1e-12 * Eigen::Matrix<double, N, N>::Identity();
  const double squared = offset.dot(solve_symmetric(regular, offset));
  return squared < kMaxDeviations * kMaxDeviations ? std::sqrt(std::max(0.0, squared)) : kMaxDeviations;
}

/// Covariance of the source's center in target.
Eigen::Matrix2d center_covariance(const SubmapDescriptor& source, const PoseGaussian& T_target_source) {
  const Eigen::Vector2d arm = T_target_source.mean * source.center - T_target_source.mean.position();
  Eigen::Matrix<double, 2, 3> J;
  J << 1.0, 0.0, -arm.y(), 0.0, 1.0, arm.x();
  return J * T_target_source.covariance * J.transpose();
}

double largest_variance(const Eigen::Matrix2d& covariance) {
  return std::max(0.0, symmetric_eigen(covariance).values[1]);
}

double hull_overlap(const SubmapDescriptor& target, const SubmapDescriptor& source, const Pose2& T_target_source) {
  ConvexPolygon moved;
  for (const Eigen::Vector2d& corner : source.hull) moved.push_back(T_target_source * corner);
  const double smaller = std::min(polygon_area(target.hull), polygon_area(source.hull));
  return smaller > 0.0 ? std::min(1.0, polygon_area(intersect_polygons(target.hull, moved)) / smaller) : 0.0;
}

double observed_overlap(const SubmapDescriptor& target, const SubmapDescriptor& source, const Pose2& T_target_source) {
  int common = 0;
  source.observed.for_each_observed([&](const Eigen::Vector2d& center) {
    common += target.observed.at(T_target_source * center) != ObservedCells::State::kUnknown ? 1 : 0;
  });
  const int fewer = std::min(target.observed.num_observed(), source.observed.num_observed());
  return fewer > 0 ? std::min(1.0, static_cast<double>(common) / fewer) : 0.0;
}

/// Correlation at a rotation, interpolated linearly between bins.
double direction_correlation_at(const SubmapDescriptor& target, const SubmapDescriptor& source, double yaw_rad) {
  const double shift = yaw_rad / std::numbers::pi * static_cast<double>(target.directions.size());
  const int before = static_cast<int>(std::floor(shift));
  const double fraction = shift - before;
  return (1.0 - fraction) * circular_correlation(target.directions, source.directions, before) +
         fraction * circular_correlation(target.directions, source.directions, before + 1);
}

double max_direction_correlation(const SubmapDescriptor& target, const SubmapDescriptor& source) {
  double best = -1.0;
  for (int shift = 0; shift < static_cast<int>(target.directions.size()); ++shift) {
    best = std::max(best, circular_correlation(target.directions, source.directions, shift));
  }
  return best;
}

double min_max_ratio(double a, double b) { return std::max(a, b) > 0.0 ? std::min(a, b) / std::max(a, b) : 1.0; }

double score_on(const NdtGrid& grid, const std::vector<Eigen::Vector2d>& points, const Pose2& T_grid_points) {
  return grid.score(points, T_grid_points).value / static_cast<double>(points.size());
}

/// NDT score on one level, minimum of both directions.
double min_mutual_score(const SubmapDescriptor& target, const SubmapDescriptor& source, const Pose2& T_target_source,
                        std::size_t level) {
  return std::min(score_on(target.ndt[level], source.points, T_target_source),
                  score_on(source.ndt[level], target.points, T_target_source.inverse()));
}

/// Inlier ratio of points in the observed cells; 0 if too few points are in observed cells.
double overlap_consistency_in(const ObservedCells& observed, const std::vector<Eigen::Vector2d>& points,
                              const Pose2& T_observed_points) {
  int num_observed = 0, on_surface = 0;
  for (const Eigen::Vector2d& p : points) {
    const Eigen::Vector2d p_observed = T_observed_points * p;
    const bool is_met = observed.is_surface_near(p_observed);
    num_observed += is_met || observed.at(p_observed) != ObservedCells::State::kUnknown ? 1 : 0;
    on_surface += is_met ? 1 : 0;
  }
  return num_observed >= kMinObservedFraction * static_cast<double>(points.size()) && num_observed > 0
             ? static_cast<double>(on_surface) / num_observed
             : 0.0;
}

}  // namespace

double mutual_overlap_consistency(const SubmapDescriptor& target, const SubmapDescriptor& source,
                                  const Pose2& T_target_source) {
  return std::min(overlap_consistency_in(target.observed, source.points, T_target_source),
                  overlap_consistency_in(source.observed, target.points, T_target_source.inverse()));
}

bool may_be_neighbors(const SubmapDescriptor& a, const SubmapDescriptor& b, const PoseGaussian& T_a_b) {
  const double distance_m = (T_a_b.mean * b.center - a.center).norm();
  return distance_m - 2.0 * std::sqrt(largest_variance(center_covariance(b, T_a_b))) < a.radius_m + b.radius_m;
}

std::vector<std::string> pair_feature_names() { return {kPairFeatures.begin(), kPairFeatures.end()}; }

SubmapComparison compare_submaps(const SubmapDescriptor& target, const SubmapDescriptor& source,
                                 const PoseGaussian& T_target_source, const NdtSettings& settings) {
  const Pose2& T_predicted = T_target_source.mean;
  const double radii_m = std::max(1e-6, target.radius_m + source.radius_m);
  const Eigen::Vector2d between = T_predicted * source.center - target.center;
  const Eigen::Matrix2d covariance = center_covariance(source, T_target_source);

  const std::optional<NdtResult> aligned = align_ndt(target.ndt, source.points, T_predicted, settings);
  const Pose2 T_aligned = aligned ? aligned->T_target_source : T_predicted;
  const double deviations =
      aligned ? mahalanobis<3>(T_target_source.residual_to_mean(T_aligned), T_target_source.covariance)
              : kMaxDeviations;
  std::vector<double> features = {
      between.norm() / radii_m,
      mahalanobis<2>(between, covariance),
      std::sqrt(largest_variance(covariance)) / radii_m,
      hull_overlap(target, source, T_predicted),
      observed_overlap(target, source, T_predicted),
      histogram_difference(target.distances, source.distances),
      max_direction_correlation(target, source),
      direction_correlation_at(target, source, T_predicted.yaw),
      min_max_ratio(static_cast<double>(target.num_points), static_cast<double>(source.num_points)),
      min_max_ratio(target.radius_m, source.radius_m),
      min_mutual_score(target, source, T_predicted, std::min<std::size_t>(1, target.ndt.size() - 1)),
      min_mutual_score(target, source, T_aligned, target.ndt.size() - 1),
      deviations,
      mutual_overlap_consistency(target, source, T_aligned)};
  return {.features = std::move(features), .aligned = aligned};
}

}  // namespace patrol::slam
