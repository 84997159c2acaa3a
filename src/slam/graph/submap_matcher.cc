#include "slam/graph/submap_matcher.h"

#include <algorithm>
#include <cmath>

#include "slam/graph/branch_and_bound.h"
#include "slam/surface_overlap.h"

namespace patrol::slam {
namespace {

constexpr int kOverlapRadius = 2;  // cells

}  // namespace

SubmapMatchResult match_submaps(const RenderedSubmap& target, const RenderedSubmap& source,
                                const PoseGaussian& prediction, const SubmapMatcherSettings& settings,
                                const ScanMatcherSettings& matching) {
  const std::vector<Eigen::Vector2d> points = positions_of(source.surface_points(), settings.search_points);
  const double std_m = std::sqrt(std::max(prediction.covariance(0, 0), prediction.covariance(1, 1))),
               std_rad = std::sqrt(prediction.covariance(2, 2));
  const SearchWindow window{.T_map_center = prediction.mean,
                            .half_width_m = std::min(settings.max_window_m, 3.0 * std_m + 0.3),
                            .half_angle_rad = std::min(settings.max_window_rad, 3.0 * std_rad + 0.05)};
  const std::optional<SearchResult> found = search_window(target.pyramid(), points, window, settings.min_search_score);
  if (!found) return {.match = {}, .failure = MatchFailure::kNotFound};
  const SearchExclusion exclusion{.T_map_center = found->T_map_points,
                                  .radius_m = settings.min_second_best_distance_m,
                                  .angle_rad = settings.min_second_best_angle_rad};
  if (search_window(target.pyramid(), points, window, settings.max_second_best_ratio * found->score, exclusion))
    return {.match = {}, .failure = MatchFailure::kAmbiguous};

  const std::optional<MatchResult> fine = match_scan(target.map(), source.surface_points(), found->T_map_points,
                                                     match_prior(found->T_map_points), matching);
  if (!fine) return {.match = {}, .failure = MatchFailure::kMismatch};
  const SurfaceOverlap forth = measure_overlap(target.map(), source.surface_points(), fine->T_map_body, kOverlapRadius);
  const SurfaceOverlap back =
      measure_overlap(source.map(), target.surface_points(), fine->T_map_body.inverse(), kOverlapRadius);
  const SubmapMatch match{.T_target_source = fine->T_map_body,
                          .information = fine->information,
                          .score = found->score,
                          .overlap_ratio = std::min(forth.overlap_ratio(), back.overlap_ratio()),
                          .inlier_ratio = std::min(forth.inlier_ratio(), back.inlier_ratio())};
  if (match.overlap_ratio < settings.min_overlap_ratio ||
      forth.num_matched * source.point_spacing_m() < settings.min_matched_length_m)
    return {.match = {}, .failure = MatchFailure::kNoOverlap};
  if (match.inlier_ratio < settings.min_inlier_ratio) return {.match = {}, .failure = MatchFailure::kMismatch};
  return {.match = match, .failure = MatchFailure::kNone};
}

}  // namespace patrol::slam
