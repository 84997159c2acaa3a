#include "slam/graph/submap_matcher.h"

#include <algorithm>
#include <cmath>
#include <span>
#include <vector>

#include <Eigen/LU>

#include "core/geometry/linear_algebra.h"
#include "slam/surface_overlap.h"

namespace patrol::slam {
namespace {

constexpr int kOverlapRadius = 2;      // cells
constexpr int kFineOverlapRadius = 1;  // cells
constexpr int kMaxCompetingPoses = 8;  // maximum number of poses that are compared with a match
// Matches that the tracked pose decides.
constexpr double kPossibleStd = 6.0;   // deviation up to which another pose is possible
constexpr double kPlausibleStd = 3.0;  // maximum deviation of the match
constexpr std::size_t kMaxPossiblePoses = 24;
constexpr double kMinScoreFraction = 0.7;  // score of a possible pose, relative to the best one
constexpr int kNumShifts = 4;              // of shifted poses on either side that a match is compared with

/// Surfaces that must overlap in a match.
enum class Coverage {
  kBoth,    ///< surfaces of both submaps
  kSource,  ///< surfaces of the source, because the target is much larger
};

/// Overlap of the surfaces of `source` with `target`, and the reverse.
struct MutualOverlap {
  SurfaceOverlap forth, back;

  double inlier_ratio() const { return std::min(forth.inlier_ratio(), back.inlier_ratio()); }
};

MutualOverlap measure_mutual_overlap(const RenderedSubmap& target, const RenderedSubmap& source,
                                     const Pose2& T_target_source, int radius) {
  return {.forth = measure_overlap(target.map(), source.surface_points(), T_target_source, radius),
          .back = measure_overlap(source.map(), target.surface_points(), T_target_source.inverse(), radius)};
}

/// Refines the pose of `source` in `target`, and checks that the surfaces of each lie on surfaces of the other.
SubmapMatchResult refine_and_check(const RenderedSubmap& target, const RenderedSubmap& source,
                                   const SearchResult& found, Coverage coverage, const SubmapMatcherSettings& settings,
                                   const ScanMatcherSettings& matching) {
  const std::optional<MatchResult> fine =
      match_scan(target.map(), source.surface_points(), found.T_map_points, match_prior(found.T_map_points), matching);
  if (!fine) return {.match = {}, .failure = MatchFailure::kMismatch};
  const MutualOverlap overlap = measure_mutual_overlap(target, source, fine->T_map_body, kOverlapRadius);
  const double forth_ratio = overlap.forth.overlap_ratio();
  const SubmapMatch match{.T_target_source = fine->T_map_body,
                          .information = fine->information,
                          .score = found.score,
                          .overlap_ratio = coverage == Coverage::kSource
                                               ? forth_ratio
                                               : std::min(forth_ratio, overlap.back.overlap_ratio()),
                          .inlier_ratio = overlap.inlier_ratio()};
  if (match.overlap_ratio < settings.min_overlap_ratio ||
      overlap.forth.num_matched * source.point_spacing_m() < settings.min_matched_length_m)
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

/// Inlier ratio of a pose at the resolution of the maps, in which doors are visible that are only two cells deep.
double fine_inlier_ratio(const RenderedSubmap& target, const RenderedSubmap& source, const Pose2& T_target_source) {
  return measure_mutual_overlap(target, source, T_target_source, kFineOverlapRadius).inlier_ratio();
}

/// Returns whether the surfaces leave the pose open along the direction that they determine least: a pose at the
/// distance of distinct poses agrees almost as well, or a nearer one at least as well. Bare walls hide such a shift.
bool slides(const RenderedSubmap& target, const RenderedSubmap& source, const SubmapMatch& match, double ratio,
            const SubmapMatcherSettings& settings) {
  const Eigen::Matrix2d covariance = match.information.inverse().topLeftCorner<2, 2>();
  const Eigen::Vector2d weakest = symmetric_eigen(covariance).vectors.col(1);
  for (int step = 1; step <= kNumShifts; ++step) {
    const double shift_m = settings.min_second_best_distance_m * step / kNumShifts;
    const double max_ratio = step < kNumShifts ? ratio : settings.max_second_best_inlier_fraction * ratio;
    for (const double sign : {-1.0, 1.0}) {
      Pose2 shifted = match.T_target_source;
      shifted.x += sign * shift_m * weakest.x();
      shifted.y += sign * shift_m * weakest.y();
      if (fine_inlier_ratio(target, source, shifted) >= max_ratio) return true;
    }
  }
  return false;
}

/// Distance of a pose from the mean of a distribution, in standard deviations.
double deviation(const PoseGaussian& distribution, const Pose2& pose) {
  const Eigen::Vector3d offset = distribution.residual_to_mean(pose);
  return std::sqrt(std::max(0.0, offset.dot(distribution.covariance.inverse() * offset)));
}

/// Window of `num_std` standard deviations and a margin around a distribution.
SearchWindow window_around(const PoseGaussian& prediction, double num_std, const SubmapMatcherSettings& settings) {
  const double std_m = std::sqrt(std::max(prediction.covariance(0, 0), prediction.covariance(1, 1))),
               std_rad = std::sqrt(prediction.covariance(2, 2));
  return {.T_map_center = prediction.mean,
          .half_width_m = std::min(settings.max_window_m, num_std * std_m + 0.3),
          .half_angle_rad = std::min(settings.max_window_rad, num_std * std_rad + 0.05)};
}

}  // namespace

SubmapMatchResult match_submaps_by_tracking(const RenderedSubmap& target, const RenderedSubmap& source,
                                            const PoseGaussian& tracked, const SubmapMatcherSettings& settings,
                                            const ScanMatcherSettings& matching) {
  const SubmapMatchResult ambiguous{.match = {}, .failure = MatchFailure::kAmbiguous};
  const std::vector<Eigen::Vector2d> points = positions_of(source.surface_points(), settings.search_points);
  const SearchWindow window = window_around(tracked, kPossibleStd, settings);
  if (window.half_width_m >= settings.max_window_m || window.half_angle_rad >= settings.max_window_rad)
    return ambiguous;  // another pose can lie outside the search
  std::vector<SearchExclusion> known;
  std::vector<SubmapMatch> possible;
  double min_score = settings.min_search_score;
  while (const std::optional<SearchResult> found = search_window(target.pyramid(), points, window, min_score, known)) {
    min_score = std::max(min_score, kMinScoreFraction * found->score);
    if (known.size() >= kMaxPossiblePoses) return ambiguous;
    known.push_back({.T_map_center = found->T_map_points,
                     .radius_m = settings.min_second_best_distance_m,
                     .angle_rad = settings.min_second_best_angle_rad});
    const SubmapMatchResult result = refine_and_check(target, source, *found, Coverage::kBoth, settings, matching);
    if (result.match && deviation(tracked, result.match->T_target_source) < kPossibleStd)
      possible.push_back(*result.match);
  }
  if (possible.empty()) return ambiguous;
  std::vector<double> ratios;
  for (const SubmapMatch& match : possible) ratios.push_back(fine_inlier_ratio(target, source, match.T_target_source));
  const auto best = static_cast<std::size_t>(std::ranges::max_element(ratios) - ratios.begin());
  const SubmapMatch& match = possible[best];
  for (std::size_t i = 0; i < possible.size(); ++i) {
    const double distance_m = (possible[i].T_target_source.position() - match.T_target_source.position()).norm();
    if (distance_m > settings.min_second_best_distance_m &&
        ratios[i] >= settings.max_second_best_inlier_fraction * ratios[best])
      return ambiguous;
  }
  if (deviation(tracked, match.T_target_source) > kPlausibleStd ||
      slides(target, source, match, ratios[best], settings))
    return ambiguous;
  return {.match = match, .failure = MatchFailure::kNone};
}

SubmapMatchResult match_submaps(const RenderedSubmap& target, const RenderedSubmap& source,
                                const PoseGaussian& prediction, const SubmapMatcherSettings& settings,
                                const ScanMatcherSettings& matching) {
  return match_in_window(target, source, window_around(prediction, 3.0, settings), Coverage::kBoth, settings, matching);
}

SubmapMatchResult locate_submap(const RenderedSubmap& map, const RenderedSubmap& source, const SearchWindow& window,
                                const SubmapMatcherSettings& settings, const ScanMatcherSettings& matching) {
  return match_in_window(map, source, window, Coverage::kSource, settings, matching);
}

}  // namespace patrol::slam
