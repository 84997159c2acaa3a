#include "slam/graph/scan_tracker.h"

#include <Eigen/LU>

#include <algorithm>
#include <cmath>

namespace patrol::slam {
namespace {

/// Odometry's tail: as if of Student's t with so many degrees of freedom.
constexpr double kTail = 4.0;
/// Who has been wrong is doubted for a while: his variance grows to what the scan said, and falls back from scan to scan.
constexpr double kForget = 0.8;
constexpr double kMostDoubt = 400.0;

double log_student(const PoseGaussian& prediction, const Pose2& pose) {
  const Eigen::Vector3d offset = prediction.offset_of(pose);
  return -0.5 * (kTail + 3.0) * std::log1p(offset.dot(prediction.covariance.inverse() * offset) / kTail);
}

bool is_apart(const Pose2& a, const Pose2& b) { return (a.position() - b.position()).norm() > 0.03 || std::abs(wrap_angle(a.yaw - b.yaw)) > 0.02; }

/// A motion as it would be after another time.
Pose2 scaled(const Pose2& motion, double factor) { return {factor * motion.x, factor * motion.y, factor * motion.yaw}; }

}  // namespace

ScanTracker::ScanTracker(const ScanTrackerSettings& settings)
    : settings_(settings), older_(settings.resolution_m, settings.max_extent_m), newer_(settings.resolution_m, settings.max_extent_m) {}

TrackedScan ScanTracker::update(const LevelScan& scan, const Pose2& T_odom_body) {
  const std::vector<MatchPoint> points = select_match_points(scan, settings_.matching.point_spacing_m, settings_.matching.max_points);
  TrackedScan tracked;
  if (!stamp_) {
    T_odom_last_ = T_odom_body;
    stamp_ = scan.stamp;
  }
  const double step_s = to_seconds(scan.stamp - *stamp_);
  const Pose2 T_last_odom = T_odom_last_.inverse() * T_odom_body;
  PoseGaussian prediction = predict_motion(T_local_last_, T_last_odom, std::max(0.0, step_s), settings_.motion);
  prediction.covariance *= odometry_doubt_;
  Hypothesis best{.T_local_body = prediction.mean, .match = {}};
  if (older_.has_surface() && !points.empty()) {
    best = try_from(prediction.mean, points, prediction, true);
    const double factor = last_step_s_ > 1e-3 ? std::clamp(step_s / last_step_s_, 0.0, 2.0) : 1.0;
    const Pose2 as_before = T_local_last_ * scaled(T_last_now_, factor);
    const auto consider = [&](const Pose2& start) {
      const Hypothesis other = try_from(start, points, prediction, false);
      if (other.match && (!best.match || is_better(other, best))) best = other;
    };
    for (const Pose2& start : {as_before, T_local_last_ * Pose2{0.0, 0.0, T_last_odom.yaw}, T_local_last_ * Pose2{-T_last_odom.x, -T_last_odom.y, T_last_odom.yaw}}) {
      if (is_apart(start, prediction.mean) && is_apart(start, best.T_local_body)) consider(start);
    }
    if (!best.match || best.match->matched_share < 0.6) consider(search_pose(older_, points, prediction.mean, settings_.matching));
  }
  tracked.T_local_body = best.T_local_body;
  const Eigen::Vector3d offset = prediction.offset_of(best.T_local_body);
  odometry_doubt_ = std::clamp(std::max(kForget * odometry_doubt_, odometry_doubt_ * offset.dot(prediction.covariance.inverse() * offset) / 3.0), 1.0, kMostDoubt);
  Eigen::Matrix3d information = prediction.covariance.inverse();
  if (best.match) {
    tracked.match_information = best.match->information;
    tracked.matched_share = best.match->matched_share;
    information += settings_.likelihood_gain * best.match->information;
  }
  tracked.covariance = information.inverse();
  const Pose2 T_keyframe_body = T_local_keyframe_.inverse() * tracked.T_local_body;
  tracked.is_keyframe = keyframes_ < settings_.initial_keyframes || T_keyframe_body.position().norm() >= settings_.keyframe_distance_m ||
                        std::abs(T_keyframe_body.yaw) >= settings_.keyframe_angle_rad;
  tracked.submap = submap_;
  if (tracked.is_keyframe) write(scan, tracked.T_local_body, tracked);
  T_last_now_ = T_local_last_.inverse() * tracked.T_local_body;
  last_step_s_ = step_s;
  T_local_last_ = tracked.T_local_body;
  T_odom_last_ = T_odom_body;
  stamp_ = scan.stamp;
  return tracked;
}

ScanTracker::Hypothesis ScanTracker::try_from(const Pose2& T_local_start, const std::vector<MatchPoint>& points, const PoseGaussian& prediction,
                                              bool is_odometry) const {
  // Where odometry has failed it still keeps what the scan leaves open from running away.
  PoseGaussian prior = prediction;
  if (!is_odometry) {
    prior.mean = T_local_start;
    prior.covariance *= 25.0;
  }
  Hypothesis hypothesis{.T_local_body = prediction.mean, .match = match_scan(older_, points, T_local_start, prior, settings_.matching)};
  if (!hypothesis.match) return hypothesis;
  hypothesis.T_local_body = hypothesis.match->T_map_body;
  hypothesis.log_prior = log_student(prediction, hypothesis.T_local_body);
  hypothesis.log_likelihoods = point_log_likelihoods(older_, points, hypothesis.T_local_body, settings_.matching);
  return hypothesis;
}

// By the points that both see in known places: the others would reward who stays where the map is.
bool ScanTracker::is_better(const Hypothesis& a, const Hypothesis& b) const {
  double gain = 0.0;
  for (std::size_t i = 0; i < a.log_likelihoods.size(); ++i) {
    const double difference = a.log_likelihoods[i] - b.log_likelihoods[i];
    if (!std::isnan(difference)) gain += difference;
  }
  return settings_.likelihood_gain * gain + a.log_prior - b.log_prior > 0.0;
}

void ScanTracker::write(const LevelScan& scan, const Pose2& T_local_body, TrackedScan& tracked) {
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
