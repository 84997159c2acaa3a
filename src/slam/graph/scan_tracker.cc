#include "slam/graph/scan_tracker.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <numbers>

#include <Eigen/LU>

#include "slam/graph/degeneracy.h"

namespace patrol::slam {
namespace {

/// Degrees of freedom of Student's t distribution of the odometry error.
constexpr double kStudentDegreesOfFreedom = 4.0;
/// Decay per scan of the inflated odometry variance, after odometry contradicted a match.
constexpr double kVarianceScaleDecay = 0.8;
constexpr double kMaxVarianceScale = 400.0;
/// Along a direction with less information than this fraction of the best one, a match is not evidence against
/// odometry.
constexpr double kMinEvidenceRatio = 0.02;
/// Number of sectors of bearings that vote between two poses.
constexpr std::size_t kSectors = 36;
/// Minimum difference of the log likelihoods of a sector's points for a vote.
constexpr double kMinVote = 2.0;
/// Squared Mahalanobis distance from the odometry prediction above which a match contradicts odometry.
constexpr double kContradiction = 16.0;
/// A match with a smaller inlier ratio triggers a window search.
constexpr double kGoodInlierRatio = 0.6;

double log_student_t(const PoseGaussian& prediction, const Pose2& pose) {
  const Eigen::Vector3d offset = prediction.residual_to_mean(pose);
  return -0.5 * (kStudentDegreesOfFreedom + 3.0) *
         std::log1p(offset.dot(prediction.covariance.inverse() * offset) / kStudentDegreesOfFreedom);
}

/// Returns the difference of two poses without its part along the direction that a match does not determine.
Eigen::Vector3d determined_offset(const Eigen::Vector3d& offset, const Eigen::Matrix3d& match_information) {
  const auto degenerate = degenerate_direction(match_information, kMinEvidenceRatio);
  if (!degenerate) return offset;
  Eigen::Vector3d determined = offset;
  determined.head<2>() -= degenerate->dot(offset.head<2>()) * *degenerate;
  return determined;
}

bool is_distinct(const Pose2& a, const Pose2& b) {
  return (a.position() - b.position()).norm() > 0.03 || std::abs(wrap_angle(a.yaw - b.yaw)) > 0.02;
}

std::size_t sector_of(const MatchPoint& point) {
  const double turn = std::atan2(point.p_body.y(), point.p_body.x()) / (2.0 * std::numbers::pi);
  return static_cast<std::size_t>((turn + 1.0) * kSectors) % kSectors;
}

/// Gain in log likelihood of one pose over another by the bearing of the points.
struct SectorGains {
  std::array<double, kSectors> gains{};
  double total = 0.0;

  /// Compares at points in observed cells of both poses; other points would favor poses with fewer observed cells.
  SectorGains(const std::vector<MatchPoint>& points, const std::vector<double>& a, const std::vector<double>& b) {
    for (std::size_t i = 0; i < points.size(); ++i) {
      const double difference = a[i] - b[i];
      if (std::isnan(difference)) continue;
      gains[sector_of(points[i])] += difference;
      total += difference;
    }
  }
  /// Returns the vote of a sector: 1 in favor, -1 against, 0 undecided.
  int vote(std::size_t sector) const { return (gains[sector] > kMinVote) - (gains[sector] < -kMinVote); }
  /// Returns the number of sectors in favor minus the number against.
  int votes() const {
    int sum = 0;
    for (std::size_t sector = 0; sector < kSectors; ++sector) sum += vote(sector);
    return sum;
  }
};

/// Scales a motion to another duration at constant velocity.
Pose2 scaled(const Pose2& motion, double factor) { return {factor * motion.x, factor * motion.y, factor * motion.yaw}; }

}  // namespace

ScanTracker::ScanTracker(const ScanTrackerSettings& settings)
    : settings_(settings),
      older_(settings.resolution_m, settings.max_extent_m),
      newer_(settings.resolution_m, settings.max_extent_m) {}

TrackedScan ScanTracker::update(const LevelScan& scan, const Pose2& T_odom_body) {
  if (!stamp_) {
    T_odom_last_ = matched_.T_odom_body = T_odom_body;
    stamp_ = matched_.stamp = scan.stamp;
  }
  const Step step{.seconds = to_seconds(scan.stamp - *stamp_), .T_last_odom = T_odom_last_.inverse() * T_odom_body};
  PoseGaussian prediction = predict_motion(matched_.T_local_body, matched_.T_odom_body.inverse() * T_odom_body,
                                           std::max(0.0, to_seconds(scan.stamp - matched_.stamp)), settings_.motion);
  prediction.covariance *= odometry_variance_scale_;
  const bool can_be_matched = older_.has_surface();
  const Hypothesis best =
      track(downsample_scan(scan, settings_.matching.point_spacing_m, settings_.matching.max_points), step, prediction);
  inflate_odometry_covariance(prediction, best);
  TrackedScan tracked = to_tracked_scan(best, prediction);
  tracked.is_keyframe = is_keyframe_due(tracked.T_local_body);
  if (tracked.is_keyframe) integrate(scan, tracked.T_local_body, tracked);
  T_last_now_ = T_local_last_.inverse() * tracked.T_local_body;
  last_step_s_ = step.seconds;
  T_local_last_ = tracked.T_local_body;
  T_odom_last_ = T_odom_body;
  stamp_ = scan.stamp;
  if (best.match || !can_be_matched)
    matched_ = {.stamp = scan.stamp, .T_local_body = tracked.T_local_body, .T_odom_body = T_odom_body};
  return tracked;
}

// Matches from the odometry prediction and from alternative start poses.
ScanTracker::Hypothesis ScanTracker::track(const std::vector<MatchPoint>& points, const Step& step,
                                           const PoseGaussian& prediction) const {
  if (!older_.has_surface() || points.empty()) return {.T_local_body = prediction.mean, .match = {}};
  Hypothesis best = match_from(prediction.mean, points, prediction, true);
  const auto consider = [&](const Pose2& start) {
    const Hypothesis other = match_from(start, points, prediction, false);
    if (!other.match) return;
    if (!best.match || (is_determined_by_scan(other, best) && is_better(other, best, points))) best = other;
  };
  const double factor = last_step_s_ > 1e-3 ? std::clamp(step.seconds / last_step_s_, 0.0, 2.0) : 1.0;
  const Pose2 as_before = scaled(T_last_now_, factor), none{0.0, 0.0, step.T_last_odom.yaw},
              opposite{-step.T_last_odom.x, -step.T_last_odom.y, step.T_last_odom.yaw};
  for (const Pose2& T_last_now : {as_before, none, opposite}) {
    const Pose2 start = T_local_last_ * T_last_now;
    if (is_distinct(start, prediction.mean) && is_distinct(start, best.T_local_body)) consider(start);
  }
  if (!best.match || best.match->inlier_ratio < kGoodInlierRatio)
    consider(search_pose(older_, points, prediction.mean, settings_.matching));
  return best.match ? without_moving_objects(best, points, prediction) : best;
}

// Only the directions that the scan determines are evidence: along a smooth corridor any pose matches.
void ScanTracker::inflate_odometry_covariance(const PoseGaussian& prediction, const Hypothesis& best) {
  Eigen::Vector3d offset = prediction.residual_to_mean(best.T_local_body);
  if (best.match) offset = determined_offset(offset, best.match->information);
  // 3 on average if the variance is correct
  const double squared = offset.dot(prediction.covariance.inverse() * offset);
  odometry_variance_scale_ =
      std::clamp(std::max(kVarianceScaleDecay * odometry_variance_scale_, odometry_variance_scale_ * squared / 3.0),
                 1.0, kMaxVarianceScale);
}

TrackedScan ScanTracker::to_tracked_scan(const Hypothesis& best, const PoseGaussian& prediction) const {
  TrackedScan tracked{.T_local_body = best.T_local_body, .submap = submap_};
  Eigen::Matrix3d information = prediction.covariance.inverse();
  if (best.match) {
    tracked.match_information = best.match->information;
    tracked.inlier_ratio = best.match->inlier_ratio;
    information += settings_.likelihood_tempering * best.match->information;
  }
  tracked.covariance = information.inverse();
  return tracked;
}

bool ScanTracker::is_keyframe_due(const Pose2& T_local_body) const {
  const Pose2 T_keyframe_body = T_local_keyframe_.inverse() * T_local_body;
  return keyframes_ < settings_.initial_keyframes ||
         T_keyframe_body.position().norm() >= settings_.keyframe_distance_m ||
         std::abs(T_keyframe_body.yaw) >= settings_.keyframe_angle_rad;
}

ScanTracker::Hypothesis ScanTracker::match_from(const Pose2& T_local_start, const std::vector<MatchPoint>& points,
                                                const PoseGaussian& prediction, bool is_odometry) const {
  // A wide prior keeps degenerate directions bounded when odometry has failed.
  PoseGaussian prior = prediction;
  if (!is_odometry) {
    prior.mean = T_local_start;
    prior.covariance *= 25.0;
  }
  Hypothesis hypothesis{.T_local_body = prediction.mean,
                        .match = match_scan(older_, points, T_local_start, prior, settings_.matching)};
  if (!hypothesis.match) return hypothesis;
  hypothesis.T_local_body = hypothesis.match->T_map_body;
  hypothesis.log_prior = log_student_t(prediction, hypothesis.T_local_body);
  hypothesis.log_likelihoods = point_log_likelihoods(older_, points, hypothesis.T_local_body, settings_.matching);
  return hypothesis;
}

// A smooth corridor matches anywhere along it: such a difference is left to odometry.
bool ScanTracker::is_determined_by_scan(const Hypothesis& a, const Hypothesis& b) {
  const Eigen::Vector3d offset(a.T_local_body.x - b.T_local_body.x, a.T_local_body.y - b.T_local_body.y,
                               wrap_angle(a.T_local_body.yaw - b.T_local_body.yaw));
  const Eigen::Vector3d determined = determined_offset(offset, a.match->information);
  return is_distinct({determined.x(), determined.y(), determined.z()}, {});
}

// A vehicle that passes has many points in few sectors, and they match best as if the robot moved with it.
bool ScanTracker::is_better(const Hypothesis& a, const Hypothesis& b, const std::vector<MatchPoint>& points) const {
  const SectorGains gains(points, a.log_likelihoods, b.log_likelihoods);
  return gains.votes() > 0 && settings_.likelihood_tempering * gains.total + a.log_prior - b.log_prior > 0.0;
}

// Without the sectors in favor of a match that contradicts odometry and the majority of the sectors.
ScanTracker::Hypothesis ScanTracker::without_moving_objects(const Hypothesis& best,
                                                            const std::vector<MatchPoint>& points,
                                                            const PoseGaussian& prediction) const {
  const Eigen::Vector3d offset =
      determined_offset(prediction.residual_to_mean(best.T_local_body), best.match->information);
  if (offset.dot(prediction.covariance.inverse() * offset) < kContradiction) return best;
  const SectorGains gains(points, best.log_likelihoods,
                          point_log_likelihoods(older_, points, prediction.mean, settings_.matching));
  if (gains.votes() > 0) return best;
  std::vector<MatchPoint> others = points;
  std::erase_if(others, [&](const MatchPoint& point) { return gains.vote(sector_of(point)) > 0; });
  return match_from(prediction.mean, others, prediction, true);
}

void ScanTracker::integrate(const LevelScan& scan, const Pose2& T_local_body, TrackedScan& tracked) {
  if (keyframes_ == 0) tracked.is_submap_start = true;
  if (older_keyframes_ >= settings_.submap_keyframes) {
    older_ = std::move(newer_);
    older_keyframes_ = newer_keyframes_;
    newer_ = GridMap(settings_.resolution_m, settings_.max_extent_m);
    newer_keyframes_ = 0;
    ++submap_;
  }
  integrate_scan(scan, T_local_body, settings_.integration, older_);
  ++older_keyframes_;
  if (newer_keyframes_ > 0 || older_keyframes_ > settings_.submap_keyframes / 2) {
    tracked.is_submap_start = tracked.is_submap_start || newer_keyframes_ == 0;
    integrate_scan(scan, T_local_body, settings_.integration, newer_);
    ++newer_keyframes_;
  }
  ++keyframes_;
  T_local_keyframe_ = T_local_body;
}

}  // namespace patrol::slam
