#include <algorithm>
#include <cmath>

#include "slam/graph/scan_tracker.h"

// Motions that are possible without odometry or after a gap between scans, and the search over them.

namespace patrol::slam {
namespace {

/// Search over possible motions: time between scans, at least because stamps of logs jitter and at most; margins.
constexpr double kMinSearch_s = 0.4, kMaxSearch_s = 0.7, kSearchMargin_m = 0.1, kSearchMarginRad = 0.05;
/// Search around the prediction by odometry after a gap between scans, in its standard deviations and at most.
constexpr double kGapSearchStd = 3.0, kMaxGapSearch_m = 3.0, kMaxGapSearchRad = 0.8;
/// Standard deviation of a motion without odometry, as a fraction of the possible motion.
constexpr double kPossibleMotionStd = 0.3;
/// Minimum score of the pose that a search finds (SearchResult), and number of levels of its pyramid.
constexpr double kMinSearchScore = 0.2;
constexpr int kSearchLevels = 4;

}  // namespace

// At constant velocity, with a covariance that contains all possible motions.
PoseGaussian ScanTracker::predict_without_odometry(const Track& track, const Step& step) const {
  const double seconds = std::clamp(step.seconds, 0.0, kMaxSearch_s),
               std_m = kPossibleMotionStd * settings_.max_speed_mps * std::max(seconds, kMinSearch_s),
               std_rad = kPossibleMotionStd * settings_.max_turn_rate_radps * std::max(seconds, kMinSearch_s);
  return {.mean = track.T_local_last * motion_as_before(track, step),
          .covariance = Eigen::Vector3d(std_m * std_m, std_m * std_m, std_rad * std_rad).asDiagonal()};
}

// At the end of the map, few points are in known cells, and a pose at which all points match is a wrong one.
ScanTracker::Hypothesis ScanTracker::match_after_gap(const Hypothesis& by_odometry,
                                                     const std::vector<MatchPoint>& points,
                                                     const PoseGaussian& prediction) {
  const auto is_likely = [&](const Hypothesis& hypothesis) {
    return hypothesis.match && usual_.has_usual_points(*hypothesis.match, hypothesis.log_likelihoods);
  };
  if (is_likely(by_odometry)) return by_odometry;
  const double variance_m2 = std::max(prediction.covariance(0, 0), prediction.covariance(1, 1));
  const SearchWindow window{
      .T_map_center = prediction.mean,
      .half_width_m = std::min(kMaxGapSearch_m, kGapSearchStd * std::sqrt(variance_m2)) + kSearchMargin_m,
      .half_angle_rad =
          std::min(kMaxGapSearchRad, kGapSearchStd * std::sqrt(prediction.covariance(2, 2))) + kSearchMarginRad};
  if (const std::optional<Pose2> found = search(window, points)) {
    Hypothesis other = match_from(*found, points, prediction, by_odometry);
    if (other.match) evaluate(other, points);
    if (is_likely(other)) return other;
  }
  return by_odometry;
}

SearchWindow ScanTracker::possible_motions(const Pose2& T_local_last, double seconds) const {
  const double limited_s = std::clamp(seconds, kMinSearch_s, kMaxSearch_s);
  return {.T_map_center = T_local_last,
          .half_width_m = settings_.max_speed_mps * limited_s + kSearchMargin_m,
          .half_angle_rad = settings_.max_turn_rate_radps * limited_s + kSearchMarginRad};
}

bool ScanTracker::is_gap(const Step& step) const {
  const SearchWindow searched = possible_motions({}, step.seconds);
  const double moved_m = step.T_last_odom.position().norm();
  return !step.is_odometry_constant && moved_m > searched.half_width_m &&
         moved_m <= settings_.max_speed_mps * step.seconds;
}

std::optional<Pose2> ScanTracker::search(const SearchWindow& window, const std::vector<MatchPoint>& points) {
  if (!pyramid_) pyramid_.emplace(maps_.older(), 2.0 * settings_.resolution_m, kSearchLevels);
  const auto found =
      search_window(*pyramid_, positions_of(points, settings_.matching.search_points), window, kMinSearchScore);
  return found ? std::optional(found->T_map_points) : std::nullopt;
}

}  // namespace patrol::slam
