#include "slam/submaps/submap_constraint_finder.h"

#include <algorithm>
#include <cmath>

#include "slam/graph/branch_and_bound.h"
#include "slam/submaps/pair_features.h"

namespace patrol::slam {
namespace {

bool has_second_best(const SubmapSurfaces& target, const SubmapSurfaces& source, const PoseGaussian& prediction,
                     const Pose2& T_target_source, const SubmapConstraintSettings& settings) {
  const double std_m = std::sqrt(std::max(prediction.covariance(0, 0), prediction.covariance(1, 1))),
               std_rad = std::sqrt(prediction.covariance(2, 2));
  const SearchWindow here{
      .T_map_center = T_target_source, .half_width_m = target.pyramid.resolution_m(), .half_angle_rad = 0.01};
  const std::optional<SearchResult> found = search_window(target.pyramid, source.descriptor.points, here, 0.0);
  if (!found) return true;  // no surface fits: every other pose is as good
  const SearchWindow around{.T_map_center = prediction.mean,
                            .half_width_m = std::min(settings.max_window_m, 3.0 * std_m),
                            .half_angle_rad = std::min(settings.max_window_rad, 3.0 * std_rad)};
  const SearchExclusion itself{.T_map_center = found->T_map_points,
                               .radius_m = settings.min_second_best_distance_m,
                               .angle_rad = settings.min_second_best_angle_rad};
  return search_window(target.pyramid, source.descriptor.points, around, settings.max_second_best_ratio * found->score,
                       std::span(&itself, 1))
      .has_value();
}

}  // namespace

SurfaceMatch match_surfaces(const SubmapSurfaces& target, const SubmapSurfaces& source,
                            const PoseGaussian& T_target_source, const SubmapSurfaceSettings& settings) {
  SubmapComparison comparison =
      compare_submaps(target.descriptor, source.descriptor, T_target_source, settings.descriptor.ndt);
  std::optional<IcpResult> fine;
  if (comparison.aligned)
    fine = align_icp(target.points, source.points, comparison.aligned->T_target_source, settings.icp);
  return {.features = std::move(comparison.features), .coarse = comparison.aligned, .fine = fine};
}

ConstraintResult find_constraint(const SubmapSurfaces& target, const SubmapSurfaces& source,
                                 const PoseGaussian& T_target_source, const BoostedStumps& model,
                                 const SubmapSurfaceSettings& surfaces, const SubmapConstraintSettings& settings) {
  const SurfaceMatch match = match_surfaces(target, source, T_target_source, surfaces);
  const double margin = model.margin(match.features);
  if (margin <= settings.min_margin) return {.constraint = {}, .failure = ConstraintRejection::kNotNeighbors};
  if (!match.fine) return {.constraint = {}, .failure = ConstraintRejection::kMismatch};

  const Pose2 shift = match.coarse->T_target_source.inverse() * match.fine->T_target_source;
  const double overlap_consistency =
      mutual_overlap_consistency(target.descriptor, source.descriptor, match.fine->T_target_source);
  if (shift.position().norm() > settings.max_fine_shift_m || std::abs(shift.yaw) > settings.max_fine_shift_rad ||
      overlap_consistency < settings.min_overlap_consistency) {
    return {.constraint = {}, .failure = ConstraintRejection::kMismatch};
  }
  if (has_second_best(target, source, T_target_source, match.fine->T_target_source, settings))
    return {.constraint = {}, .failure = ConstraintRejection::kAmbiguous};
  return {.constraint = SubmapConstraint{.T_target_source = match.fine->T_target_source,
                                         .information = match.fine->information,
                                         .margin = margin,
                                         .overlap_consistency = overlap_consistency},
          .failure = ConstraintRejection::kNone};
}

}  // namespace patrol::slam
