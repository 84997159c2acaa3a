#include "slam/graph/submap_matcher.h"

#include <algorithm>
#include <cmath>
#include <span>
#include <vector>

#include "slam/surface_overlap.h"

namespace patrol::slam {
namespace {

constexpr int kOverlapRadius = 2;      // cells
constexpr int kMaxCompetingPoses = 8;  // maximum number of poses that are compared with a match

/// Surfaces that must overlap in a match.
enum class Coverage {
  kBoth,    ///< those of both submaps
  kSource,  ///< those of the source, because the target is much larger
};

/// Refines the pose of `source` in `target`, and checks that the surfaces of each lie on surfaces of the other.
SubmapMatchResult refine_and_check(const RenderedSubmap& target, const RenderedSubmap& source,
                                   const SearchResult& found, Coverage coverage, const SubmapMatcherSettings& settings,
                                   const ScanMatcherSettings& matching) {
  const std::optional<MatchResult> fine =
      match_scan(target.map(), source.surface_points(), found.T_map_points, match_prior(found.T_map_points), matching);
  if (!fine) return {.match = {}, .failure = MatchFailure::kMismatch};
  const SurfaceOverlap forth = measure_overlap(target.map(), source.surface_points(), fine->T_map_body, kOverlapRadius);
  const SurfaceOverlap back =
      measure_overlap(source.map(), target.surface_points(), fine->T_map_body.inverse(), kOverlapRadius);
  const SubmapMatch match{.T_target_source = fine->T_map_body,
                          .information = fine->information,
                          .score = found.score,
                          .overlap_ratio = coverage == Coverage::kSource
                                               ? forth.overlap_ratio()
                                               : std::min(forth.overlap_ratio(), back.overlap_ratio()),
                          .inlier_ratio = std::min(forth.inlier_ratio(), back.inlier_ratio())};
  if (match.overlap_ratio < settings.min_overlap_ratio ||
      forth.num_matched * source.point_spacing_m() < settings.min_matched_length_m)
    return {.match = {}, .failure = MatchFailure::kNoOverlap};
  if (match.inlier_ratio < settings.min_inlier_ratio) return {.match = {}, .failure = MatchFailure::kMismatch};
  return {.match = match, .failure = MatchFailure::kNone};
}

/// Returns whether a shifted pose in the window would be accepted as well, and agrees almost as well where the submaps
/// overlap. In a row of identical doors, a pose that is off by a door can have the larger overlap, and with it the
/// higher score, than the true one.
bool has_competing_pose(const RenderedSubmap& target, const RenderedSubmap& source, const SubmapMatch& match,
                        const std::vector<Eigen::Vector2d>& points, const SearchWindow& window, Coverage coverage,
                        const SubmapMatcherSettings& settings, const ScanMatcherSettings& matching) {
  const SearchWindow same_angle{
      .T_map_center = {window.T_map_center.x, window.T_map_center.y, match.T_target_source.yaw},
      .half_width_m = window.half_width_m,
      .half_angle_rad = 0.0};
  std::vector<SearchExclusion> known = {{.T_map_center = match.T_target_source,
                                         .radius_m = settings.min_second_best_distance_m,
                                         .angle_rad = settings.min_second_best_angle_rad}};
  while (known.size() <= kMaxCompetingPoses) {
    const std::optional<SearchResult> other =
        search_window(target.pyramid(), points, same_angle, settings.min_search_score, known);
    if (!other) return false;
    const SubmapMatchResult competing = refine_and_check(target, source, *other, coverage, settings, matching);
    if (competing.match &&
        competing.match->inlier_ratio >= settings.max_second_best_inlier_fraction * match.inlier_ratio &&
        (competing.match->T_target_source.position() - match.T_target_source.position()).norm() >
            settings.min_second_best_distance_m)
      return true;
    known.push_back({.T_map_center = other->T_map_points,
                     .radius_m = settings.min_second_best_distance_m,
                     .angle_rad = settings.min_second_best_angle_rad});
  }
  return false;
}

SubmapMatchResult match_in_window(const RenderedSubmap& target, const RenderedSubmap& source,
                                  const SearchWindow& window, Coverage coverage, const SubmapMatcherSettings& settings,
                                  const ScanMatcherSettings& matching) {
  const std::vector<Eigen::Vector2d> points = positions_of(source.surface_points(), settings.search_points);
  const std::optional<SearchResult> found = search_window(target.pyramid(), points, window, settings.min_search_score);
  if (!found) return {.match = {}, .failure = MatchFailure::kNotFound};
  const SearchExclusion best{.T_map_center = found->T_map_points,
                             .radius_m = settings.min_second_best_distance_m,
                             .angle_rad = settings.min_second_best_angle_rad};
  if (search_window(target.pyramid(), points, window, settings.max_second_best_ratio * found->score,
                    std::span(&best, 1)))
    return {.match = {}, .failure = MatchFailure::kAmbiguous};
  const SubmapMatchResult result = refine_and_check(target, source, *found, coverage, settings, matching);
  if (result.match && has_competing_pose(target, source, *result.match, points, window, coverage, settings, matching))
    return {.match = {}, .failure = MatchFailure::kAmbiguous};
  return result;
}

}  // namespace

SubmapMatchResult match_submaps(const RenderedSubmap& target, const RenderedSubmap& source,
                                const PoseGaussian& prediction, const SubmapMatcherSettings& settings,
                                const ScanMatcherSettings& matching) {
  const double std_m = std::sqrt(std::max(prediction.covariance(0, 0), prediction.covariance(1, 1))),
               std_rad = std::sqrt(prediction.covariance(2, 2));
  const SearchWindow window{.T_map_center = prediction.mean,
                            .half_width_m = std::min(settings.max_window_m, 3.0 * std_m + 0.3),
                            .half_angle_rad = std::min(settings.max_window_rad, 3.0 * std_rad + 0.05)};
  return match_in_window(target, source, window, Coverage::kBoth, settings, matching);
}

SubmapMatchResult locate_submap(const RenderedSubmap& map, const RenderedSubmap& source, const SearchWindow& window,
                                const SubmapMatcherSettings& settings, const ScanMatcherSettings& matching) {
  return match_in_window(map, source, window, Coverage::kSource, settings, matching);
}

}  // namespace patrol::slam
