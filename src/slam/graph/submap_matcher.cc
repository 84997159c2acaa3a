#include "slam/graph/submap_matcher.h"

#include <algorithm>
#include <cmath>

#include "slam/graph/branch_and_bound.h"

namespace patrol::slam {
namespace {

std::vector<Eigen::Vector2d> thinned(const std::vector<MatchPoint>& points, std::size_t limit) {
  std::vector<Eigen::Vector2d> chosen;
  const std::size_t count = std::min(limit, points.size());
  for (std::size_t i = 0; i < count; ++i) chosen.push_back(points[i * points.size() / count].p_body);
  return chosen;
}

/// Agreement of the surfaces of one submap with the map of another.
struct Overlap {
  double known_share = 0.0;
  double matched_share = 0.0;
  double matched_length_m = 0.0;
};

Overlap overlap_of(const GridMap& map, const DrawnSubmap& other, const Pose2& T_map_other) {
  const std::vector<MatchPoint>& points = other.surface_points();
  int known = 0, matched = 0;
  for (const MatchPoint& point : points) {
    const Cell cell = map.cell_at(T_map_other * point.p_body);
    const bool is_matched = map.is_surface_within(cell, 2);
    const GridCell* there = map.find(cell);
    if (!is_matched && (!there || !there->is_known())) continue;
    ++known;
    matched += is_matched ? 1 : 0;
  }
  return {.known_share = points.empty() ? 0.0 : static_cast<double>(known) / static_cast<double>(points.size()),
          .matched_share = known == 0 ? 0.0 : static_cast<double>(matched) / known,
          .matched_length_m = matched * other.point_spacing_m()};
}

}  // namespace

SubmapMatchResult match_submaps(const DrawnSubmap& target, const DrawnSubmap& source, const PoseGaussian& prediction,
                                const SubmapMatcherSettings& settings, const ScanMatcherSettings& matching) {
  const std::vector<Eigen::Vector2d> points = thinned(source.surface_points(), static_cast<std::size_t>(settings.search_points));
  const double std_m = std::sqrt(std::max(prediction.covariance(0, 0), prediction.covariance(1, 1))), std_rad = std::sqrt(prediction.covariance(2, 2));
  const SearchWindow window{.T_map_center = prediction.mean,
                            .half_width_m = std::min(settings.max_window_m, 3.0 * std_m + 0.3),
                            .half_angle_rad = std::min(settings.max_window_rad, 3.0 * std_rad + 0.05)};
  const std::optional<SearchResult> found = search_window(target.pyramid(), points, window, settings.min_search_score);
  if (!found) return {.match = {}, .failure = MatchFailure::kNotFound};
  const SearchExclusion exclusion{.T_map_center = found->T_map_points, .radius_m = settings.ambiguity_distance_m, .angle_rad = settings.ambiguity_angle_rad};
  if (search_window(target.pyramid(), points, window, settings.ambiguity * found->score, exclusion)) return {.match = {}, .failure = MatchFailure::kAmbiguous};

  const std::optional<MatchResult> fine = match_scan(target.map(), source.surface_points(), found->T_map_points, start_of_match(found->T_map_points), matching);
  if (!fine) return {.match = {}, .failure = MatchFailure::kMismatch};
  const Overlap forth = overlap_of(target.map(), source, fine->T_map_body);
  const Overlap back = overlap_of(source.map(), target, fine->T_map_body.inverse());
  const SubmapMatch match{.T_target_source = fine->T_map_body,
                          .information = fine->information,
                          .score = found->score,
                          .known_share = std::min(forth.known_share, back.known_share),
                          .matched_share = std::min(forth.matched_share, back.matched_share)};
  if (match.known_share < settings.min_known_share || forth.matched_length_m < settings.min_matched_length_m) return {.match = {}, .failure = MatchFailure::kNoOverlap};
  if (match.matched_share < settings.min_matched_share) return {.match = {}, .failure = MatchFailure::kMismatch};
  return {.match = match, .failure = MatchFailure::kNone};
}

}  // namespace patrol::slam
