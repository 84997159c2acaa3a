#include "slam/graph/submap_matcher.h"

#include <algorithm>
#include <cmath>

#include "slam/graph/branch_and_bound.h"

namespace patrol::slam {
namespace {

/// Agreement of the surfaces of one submap with the map of another.
struct Overlap {
  double overlap_ratio = 0.0;
  double inlier_ratio = 0.0;
  double matched_length_m = 0.0;
};

Overlap measure_overlap(const GridMap& map, const RenderedSubmap& other, const Pose2& T_map_other) {
  const std::vector<MatchPoint>& points = other.surface_points();
  int num_observed = 0, matched = 0;
  for (const MatchPoint& point : points) {
    const Cell cell = map.cell_at(T_map_other * point.p_body);
    const bool is_matched = map.is_surface_within(cell, 2);
    const GridCell* there = map.find(cell);
    if (!is_matched && (!there || !there->is_observed())) continue;
    ++num_observed;
    matched += is_matched ? 1 : 0;
  }
  return {.overlap_ratio =
              points.empty() ? 0.0 : static_cast<double>(num_observed) / static_cast<double>(points.size()),
          .inlier_ratio = num_observed == 0 ? 0.0 : static_cast<double>(matched) / num_observed,
          .matched_length_m = matched * other.point_spacing_m()};
}

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
  const Overlap forth = measure_overlap(target.map(), source, fine->T_map_body);
  const Overlap back = measure_overlap(source.map(), target, fine->T_map_body.inverse());
  const SubmapMatch match{.T_target_source = fine->T_map_body,
                          .information = fine->information,
                          .score = found->score,
                          .overlap_ratio = std::min(forth.overlap_ratio, back.overlap_ratio),
                          .inlier_ratio = std::min(forth.inlier_ratio, back.inlier_ratio)};
  if (match.overlap_ratio < settings.min_overlap_ratio || forth.matched_length_m < settings.min_matched_length_m)
    return {.match = {}, .failure = MatchFailure::kNoOverlap};
  if (match.inlier_ratio < settings.min_inlier_ratio) return {.match = {}, .failure = MatchFailure::kMismatch};
  return {.match = match, .failure = MatchFailure::kNone};
}

}  // namespace patrol::slam
