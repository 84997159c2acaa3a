#pragma once

#include <optional>

#include "core/settings.h"
#include "slam/graph/submap.h"
#include "slam/pose_gaussian.h"
#include "slam/scan_matcher.h"

namespace patrol::slam {

struct SubmapMatcherSettings {
  double min_search_score = 0.35;     ///< of the points' mean likelihood, for a search's result to be looked at
  double max_window_m = 15.0;         ///< of the search, each way: more has to be found otherwise
  double max_window_rad = 0.8;
  int search_points = 300;
  double min_known_share = 0.35;      ///< of either's points, that lie where the other knows something
  double min_matched_share = 0.75;    ///< and of these, that meet a surface of the other, for both
  double min_matched_length_m = 8.0;  ///< of surface that meets
  double ambiguity = 0.9;             ///< another pose that scores more than this share of the best makes the match worthless
  double ambiguity_distance_m = 0.8;  ///< so far off it is another pose
  double ambiguity_angle_rad = 0.35;

  template <typename Self, typename Visitor>
  static void fields(Self& self, Visitor& visit) {
    visit("min_search_score", self.min_search_score, between(0.0, 1.0));
    visit("max_window_m", self.max_window_m, between(0.1, 100.0));
    visit("max_window_rad", self.max_window_rad, between(0.01, 3.2));
    visit("search_points", self.search_points, between(10, 100000));
    visit("min_known_share", self.min_known_share, between(0.0, 1.0));
    visit("min_matched_share", self.min_matched_share, between(0.0, 1.0));
    visit("min_matched_length_m", self.min_matched_length_m, at_least(0.0));
    visit("ambiguity", self.ambiguity, between(0.0, 1.0));
    visit("ambiguity_distance_m", self.ambiguity_distance_m, at_least(0.0));
    visit("ambiguity_angle_rad", self.ambiguity_angle_rad, at_least(0.0));
  }
};

struct SubmapMatch {
  Pose2 T_target_source;
  Eigen::Matrix3d information = Eigen::Matrix3d::Zero();  ///< of x, y, yaw in target, as if all points were independent
  double score = 0.0;          ///< of the search
  double known_share = 0.0;    ///< the smaller of both directions
  double matched_share = 0.0;  ///< likewise
};

/// Why two submaps were not joined.
enum class MatchFailure { kNone, kNotFound, kAmbiguous, kNoOverlap, kMismatch };

struct SubmapMatchResult {
  std::optional<SubmapMatch> match;
  MatchFailure failure = MatchFailure::kNone;
};

/// Where a match with a submap begins, and how far it may go where the surfaces leave it open: 0.2 m and 0.05 rad.
inline PoseGaussian start_of_match(const Pose2& T_submap_start) {
  return {.mean = T_submap_start, .covariance = Eigen::Vector3d(0.2 * 0.2, 0.2 * 0.2, 0.05 * 0.05).asDiagonal()};
}

/// Where the source lies in the target, searched within three standard deviations of the prediction: branch and bound for the coarse pose, another for a
/// rival as good, then Gauss-Newton on lines, then a look whether each one's surfaces lie on the other's wherever the other has looked.
SubmapMatchResult match_submaps(const DrawnSubmap& target, const DrawnSubmap& source, const PoseGaussian& prediction,
                                const SubmapMatcherSettings& settings, const ScanMatcherSettings& matching);

}  // namespace patrol::slam
