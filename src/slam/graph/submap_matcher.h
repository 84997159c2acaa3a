#pragma once

#include <optional>

#include "slam/graph/branch_and_bound.h"
#include "slam/graph/submap.h"
#include "slam/graph/submap_matcher_settings.h"
#include "slam/pose_gaussian.h"
#include "slam/scan_matcher.h"

namespace patrol::slam {

struct SubmapMatch {
  Pose2 T_target_source;
  /// Information of x, y, yaw in target, with independent points.
  Eigen::Matrix3d information = Eigen::Matrix3d::Zero();
  double score = 0.0;          ///< score of the search
  double overlap_ratio = 0.0;  ///< overlap ratio, minimum of both directions
  double inlier_ratio = 0.0;   ///< inlier ratio, minimum of both directions
};

/// Reason for rejecting a submap match.
enum class MatchFailure { kNone, kNotFound, kAmbiguous, kNoOverlap, kMismatch };

struct SubmapMatchResult {
  std::optional<SubmapMatch> match;
  MatchFailure failure = MatchFailure::kNone;
};

/// Prior of a match with a submap. It bounds degenerate directions with standard deviations of 0.2 m and 0.05 rad.
inline PoseGaussian match_prior(const Pose2& T_submap_start) {
  return {.mean = T_submap_start, .covariance = Eigen::Vector3d(0.2 * 0.2, 0.2 * 0.2, 0.05 * 0.05).asDiagonal()};
}

/// Matches two submaps within three standard deviations of the prediction. A branch-and-bound search gives the coarse
/// pose, a second one checks for an ambiguous match, and Gauss-Newton on lines refines the pose. The surfaces of each
/// submap must lie on surfaces of the other wherever the other has observed cells. Finally, no other pose of the same
/// angle in the window may pass these tests with nearly the same inlier ratio.
SubmapMatchResult match_submaps(const RenderedSubmap& target, const RenderedSubmap& source,
                                const PoseGaussian& prediction, const SubmapMatcherSettings& settings,
                                const ScanMatcherSettings& matching);

/// Decides a match that match_submaps() rejects as ambiguous, by the pose that the tracked scans predict. The match is
/// the only pose within six standard deviations of `tracked` that passes the tests, and lies within three. Inlier
/// ratios are compared at the resolution of the maps. Besides, a shift along the direction that the surfaces determine
/// least must reduce the ratio.
SubmapMatchResult match_submaps_by_tracking(const RenderedSubmap& target, const RenderedSubmap& source,
                                            const PoseGaussian& tracked, const SubmapMatcherSettings& settings,
                                            const ScanMatcherSettings& matching);

/// Finds a submap in a map that contains many of them, at any pose of its surfaces in `window`. Like match_submaps, but
/// only the source has to overlap the map; a competing pose has the angle of the match, or a score almost as high.
SubmapMatchResult locate_submap(const RenderedSubmap& map, const RenderedSubmap& source, const SearchWindow& window,
                                const SubmapMatcherSettings& settings, const ScanMatcherSettings& matching);

}  // namespace patrol::slam
