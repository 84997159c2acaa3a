#include "slam/submaps/submap_joiner.h"

#include <algorithm>
#include <cmath>

#include "slam/graph/branch_and_bound.h"
#include "slam/submaps/pair_features.h"

namespace patrol::slam {
namespace {

bool has_rival(const SubmapSurfaces& target, const SubmapSurfaces& source, const PoseGaussian& prediction, const Pose2& T_target_source,
               const SubmapJoinerSettings& settings) {
  const double std_m = std::sqrt(std::max(prediction.covariance(0, 0), prediction.covariance(1, 1))), std_rad = std::sqrt(prediction.covariance(2, 2));
  const SearchWindow here{.T_map_center = T_target_source, .half_width_m = target.pyramid.resolution_m(), .half_angle_rad = 0.01};
  const std::optional<SearchResult> found = search_window(target.pyramid, source.shape.points, here, 0.0);
  if (!found) return true;  // what fits nothing is no better than any other
  const SearchWindow around{.T_map_center = prediction.mean,
                            .half_width_m = std::min(settings.max_window_m, 3.0 * std_m),
                            .half_angle_rad = std::min(settings.max_window_rad, 3.0 * std_rad)};
  const SearchExclusion itself{.T_map_center = found->T_map_points, .radius_m = settings.rival_distance_m, .angle_rad = settings.rival_angle_rad};
  return search_window(target.pyramid, source.shape.points, around, settings.rival_share * found->score, itself).has_value();
}

}  // namespace

JoinResult join_submaps(const SubmapSurfaces& target, const SubmapSurfaces& source, const PoseGaussian& T_target_source, const BoostedStumps& model,
                        const SubmapSurfaceSettings& surfaces, const SubmapJoinerSettings& settings) {
  const SubmapComparison comparison = compare_submaps(target.shape, source.shape, T_target_source, surfaces.shape.ndt);
  const double margin = model.margin(comparison.features);
  if (!comparison.aligned || margin <= settings.min_margin) return {.joint = {}, .failure = JoinFailure::kStrangers};

  const Pose2& T_coarse = comparison.aligned->T_target_source;
  const std::optional<IcpResult> fine = align_icp(target.points, source.points.tree().points(), T_coarse, surfaces.icp);
  if (!fine) return {.joint = {}, .failure = JoinFailure::kMismatch};
  const Pose2 shift = T_coarse.inverse() * fine->T_target_source;
  const double agreement = mutual_agreement(target.shape, source.shape, fine->T_target_source);
  if (shift.position().norm() > settings.max_fine_shift_m || std::abs(shift.yaw) > settings.max_fine_shift_rad || agreement < settings.min_agreement) {
    return {.joint = {}, .failure = JoinFailure::kMismatch};
  }
  if (has_rival(target, source, T_target_source, fine->T_target_source, settings)) return {.joint = {}, .failure = JoinFailure::kAmbiguous};
  return {.joint = SubmapJoint{.T_target_source = fine->T_target_source, .information = fine->information, .margin = margin, .agreement = agreement}, .failure = JoinFailure::kNone};
}

}  // namespace patrol::slam
