#include "slam/graph/scan_tracker.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <utility>

#include <Eigen/LU>

#include "slam/graph/degeneracy.h"
#include "slam/graph/sector_gains.h"
#include "slam/rigid_motion.h"

namespace patrol::slam {
namespace {

/// Degrees of freedom of Student's t distribution of the odometry error.
constexpr double kStudentDegreesOfFreedom = 4.0;
/// Decay per scan of the inflated odometry variance, after odometry contradicted a match.
constexpr double kVarianceScaleDecay = 0.8;
constexpr double kMaxVarianceScale = 400.0;
/// Along a direction with less information than this fraction of the best one, a match is no evidence against odometry.
constexpr double kMinEvidenceRatio = 0.02;
/// Squared Mahalanobis distance from the odometry prediction above which a match contradicts odometry; near slopes,
/// where wheels slip, above which a match that is worse than usual is one with the ground.
constexpr double kContradiction = 16.0, kGroundContradiction = 100.0;
/// Number of points of a scan that can have independent errors.
constexpr double kIndependentPoints = 45.0;
/// Motion during which odometry does not change, so that it is constant.
constexpr double kConstantMotion_m = 0.3, kConstantMotionRad = 0.3;
/// Tracks of sparse scans: number at most, log probability relative to the best one at least, and weight of the earlier
/// scans per scan.
constexpr std::size_t kMaxTracks = 8;
constexpr double kMaxScoreLoss = 60.0, kScoreMemory = 0.9;

double log_student_t(const PoseGaussian& prediction, const Pose2& pose) {
  const Eigen::Vector3d offset = prediction.residual_to_mean(pose);
  return -0.5 * (kStudentDegreesOfFreedom + 3.0) *
         std::log1p(offset.dot(prediction.covariance.inverse() * offset) / kStudentDegreesOfFreedom);
}

/// Squared Mahalanobis distance of a pose from the prediction, along the directions that the match determines.
double squared_contradiction(const PoseGaussian& prediction, const Pose2& pose, const MatchResult& match) {
  const auto offset = determined_offset(prediction.residual_to_mean(pose), match.information, kMinEvidenceRatio);
  return offset.dot(prediction.covariance.inverse() * offset);
}

bool is_distinct(const Pose2& a, const Pose2& b) {
  return (a.position() - b.position()).norm() > 0.03 || std::abs(wrap_angle(a.yaw - b.yaw)) > 0.02;
}

bool is_same(const Pose2& a, const Pose2& b) { return a.x == b.x && a.y == b.y && a.yaw == b.yaw; }

int num_hits(const LevelScan& scan) {
  return static_cast<int>(
      std::count_if(scan.beams.begin(), scan.beams.end(), [](const LevelScan::Beam& beam) { return beam.is_hit; }));
}

}  // namespace

ScanTracker::ScanTracker(const ScanTrackerSettings& settings) : settings_(settings), maps_(settings) {}

TrackedScan ScanTracker::update(const LevelScan& scan, const Pose2& T_odom_stamp) {
  const Pose2 T_odom_body = delay_.compensated(scan.stamp, T_odom_stamp);
  if (!stamp_) {
    T_odom_last_ = tracks_[0].matched.T_odom_body = T_odom_body;
    stamp_ = tracks_[0].matched.stamp = scan.stamp;
  }
  Step step{.stamp = scan.stamp,
            .seconds = to_seconds(scan.stamp - *stamp_),
            .T_odom_body = T_odom_body,
            .T_last_odom = correction_.corrected(T_odom_last_.inverse() * T_odom_body),
            .is_sparse = num_hits(scan) < settings_.min_hits,
            .is_odometry_constant = is_odometry_constant_ && is_same(T_odom_last_, T_odom_body)};
  step.is_gap = is_gap(step);
  uneven_ground_.add(scan, step.T_last_odom.position().norm());
  const bool can_be_matched = maps_.older().has_surface();
  if (!step.is_sparse) tracks_.resize(1);
  const std::vector<Branch> branches =
      continue_tracks(downsample_scan(scan, settings_.matching.point_spacing_m, settings_.matching.max_points), step);
  std::vector<Track> continued;
  for (const Branch& branch : branches) {
    continued.push_back(continued_track(branch, step, branch.best.match || !can_be_matched));
    continued.back().score -= branches.front().score;
  }
  const Branch& best = branches.front();
  if (best.best.match) usual_.update(*best.best.match, best.best.log_likelihoods);
  calibrate_odometry(scan.stamp, tracks_[best.track].matched, T_odom_body, best.best);
  tracks_ = std::move(continued);
  TrackedScan tracked = to_tracked_scan(best.best, best.prediction);
  tracked.is_keyframe = is_keyframe_due(tracked.T_local_body);
  const bool is_grouped = step.is_sparse || settings_.groups_scans;
  if (is_grouped) {
    scans_since_keyframe_.add(scan, tracked.T_local_body);
  } else {
    scans_since_keyframe_.clear();
  }
  if (tracked.is_keyframe) {
    tracked.scans = is_grouped ? scans_since_keyframe_.take() : ScanGroup(scan);
    integrate(tracked);
  }
  delay_.update(tracked.T_local_body.yaw);
  update_constant_odometry(T_odom_body, tracked.T_local_body);
  last_step_s_ = step.seconds;
  T_odom_last_ = T_odom_body;
  stamp_ = scan.stamp;
  return tracked;
}

// Without a match and without odometry, the robot is assumed to stop.
ScanTracker::Track ScanTracker::continued_track(const Branch& branch, const Step& step, bool is_fixed) const {
  const Track& before = tracks_[branch.track];
  const Pose2& T_local_now = branch.best.T_local_body;
  const Pose2 moved = before.T_local_last.inverse() * T_local_now;
  return {.T_local_last = T_local_now,
          .T_last_now = is_fixed || !step.is_odometry_constant ? moved : Pose2{},
          .matched = is_fixed ? Fix{.stamp = step.stamp, .T_local_body = T_local_now, .T_odom_body = step.T_odom_body}
                              : before.matched,
          .odometry_variance_scale =
              updated_variance_scale(before.odometry_variance_scale, branch.prediction, branch.best),
          .score = branch.score};
}

PoseGaussian ScanTracker::predict(const Track& track, const Step& step) const {
  if (step.is_odometry_constant) return predict_without_odometry(track, step);
  const Fix& from = track.matched;
  const Pose2 odometry = correction_.corrected(from.T_odom_body.inverse() * step.T_odom_body);
  PoseGaussian prediction =
      predict_motion(from.T_local_body, odometry, std::max(0.0, to_seconds(step.stamp - from.stamp)), settings_.motion);
  prediction.covariance *= track.odometry_variance_scale;
  return prediction;
}

Pose2 ScanTracker::motion_as_before(const Track& track, const Step& step) const {
  return scaled_motion(track.T_last_now, last_step_s_ > 1e-3 ? std::clamp(step.seconds / last_step_s_, 0.0, 2.0) : 1.0);
}

// Scans that change while odometry does not are evidence of motion only along directions that they determine, because
// elsewhere the tracked pose follows odometry.
void ScanTracker::update_constant_odometry(const Pose2& T_odom_body, const Pose2& T_local_body) {
  if (!is_same(T_odom_last_, T_odom_body)) {
    T_local_constant_ = T_local_body;
    is_odometry_constant_ = false;
  } else {
    const Pose2 moved = T_local_constant_.inverse() * T_local_body;
    is_odometry_constant_ = is_odometry_constant_ || moved.position().norm() > kConstantMotion_m ||
                            std::abs(moved.yaw) > kConstantMotionRad;
  }
}

// Of dense scans, the best continuation; of sparse scans, several that differ, the one with the highest score first.
std::vector<ScanTracker::Branch> ScanTracker::continue_tracks(const std::vector<MatchPoint>& points, const Step& step) {
  if (!maps_.older().has_surface() || points.empty()) {
    const PoseGaussian prediction = predict(tracks_[0], step);
    return {{.track = 0, .prediction = prediction, .best = {.T_local_body = prediction.mean, .match = {}}}};
  }
  std::vector<Branch> branches;
  for (std::size_t t = 0; t < tracks_.size(); ++t) {
    const PoseGaussian prediction = predict(tracks_[t], step);
    const Hypothesis by_odometry = match_by_odometry(points, prediction);
    const Hypothesis best = match_by_alternatives(tracks_[t], by_odometry, points, step, prediction);
    branches.push_back(to_branch(t, step, best, prediction));
    if (!step.is_sparse) return branches;
    if (is_distinct(best.T_local_body, by_odometry.T_local_body))
      branches.push_back(to_branch(t, step, by_odometry, prediction));
  }
  for (Branch& branch : branches) branch.score = score(tracks_[branch.track], branch, points);
  std::stable_sort(branches.begin(), branches.end(),
                   [](const Branch& a, const Branch& b) { return a.score > b.score; });
  const double kept_from = branches.front().score - kMaxScoreLoss;
  std::vector<Branch> kept;
  for (Branch& branch : branches) {
    const bool is_new = std::none_of(kept.begin(), kept.end(), [&](const Branch& better) {
      return !is_distinct(better.best.T_local_body, branch.best.T_local_body);
    });
    if (is_new && kept.size() < kMaxTracks && branch.score > kept_from) kept.push_back(std::move(branch));
  }
  return kept;
}

double ScanTracker::score(const Track& track, const Branch& branch, const std::vector<MatchPoint>& points) const {
  const std::vector<double> log_likelihoods =
      branch.best.log_likelihoods.size() != points.size()
          ? point_log_likelihoods(maps_.older(), points, branch.best.T_local_body, settings_.matching)
          : branch.best.log_likelihoods;
  double sum = 0.0;
  for (const double value : log_likelihoods) sum += std::isnan(value) ? usual_.unknown_log_likelihood() : value;
  return kScoreMemory * track.score + tempering(points.size()) * sum +
         log_student_t(branch.prediction, branch.best.T_local_body) -
         0.5 * std::log(branch.prediction.covariance.determinant());
}

// Matches from alternative start poses, unless the one by odometry is better.
ScanTracker::Hypothesis ScanTracker::match_by_alternatives(const Track& track, const Hypothesis& by_odometry,
                                                           const std::vector<MatchPoint>& points, const Step& step,
                                                           const PoseGaussian& prediction) {
  if (step.is_gap) return match_after_gap(by_odometry, points, prediction);
  Hypothesis best = by_odometry;
  const bool is_likely = best.match && usual_.has_usual_points(*best.match, best.log_likelihoods);
  if (is_likely && step.is_sparse) return without_moving_objects(best, points, prediction);
  const auto consider = [&](const Pose2& start) {
    Hypothesis other = match_from(start, points, prediction, best);
    if (!other.match || (best.match && !is_determined_by_scan(other, best))) return;
    evaluate(other, points);
    if (!best.match || is_better(other, best, points)) best = std::move(other);
  };
  const Pose2 as_before = motion_as_before(track, step), none{0.0, 0.0, step.T_last_odom.yaw},
              opposite{-step.T_last_odom.x, -step.T_last_odom.y, step.T_last_odom.yaw};
  for (const Pose2& T_last_now : {as_before, none, opposite}) {
    const Pose2 start = track.T_local_last * T_last_now;
    if (is_distinct(start, prediction.mean) && is_distinct(start, best.T_local_body)) consider(start);
  }
  if (!is_likely || !usual_.has_usual_loss(best.log_likelihoods)) {
    if (const std::optional<Pose2> found = search(possible_motions(track.T_local_last, step.seconds), points))
      consider(*found);
  }
  return best.match ? without_moving_objects(best, points, prediction) : best;
}

// The outline of the ground moves with the robot, so a match with it contradicts odometry. The scale factor of the
// odometry variance is left out: a first wrong match would increase it for the next.
ScanTracker::Branch ScanTracker::to_branch(std::size_t track, const Step& step, const Hypothesis& best,
                                           const PoseGaussian& prediction) const {
  Branch branch{.track = track, .prediction = prediction, .best = best};
  if (!best.match || !uneven_ground_.is_near()) return branch;
  const double scale = step.is_odometry_constant ? 1.0 : tracks_[track].odometry_variance_scale;
  if (scale * squared_contradiction(prediction, best.T_local_body, *best.match) > kGroundContradiction &&
      !usual_.has_usual_points(*best.match, best.log_likelihoods))
    branch.best = {.T_local_body = prediction.mean};
  return branch;
}

// Only the directions that the scan determines are evidence: along a smooth corridor any pose matches.
double ScanTracker::updated_variance_scale(double scale, const PoseGaussian& prediction, const Hypothesis& best) {
  Eigen::Vector3d offset = prediction.residual_to_mean(best.T_local_body);
  if (best.match) offset = determined_offset(offset, best.match->information, kMinEvidenceRatio);
  // 3 on average if the variance is correct
  const double squared = offset.dot(prediction.covariance.inverse() * offset);
  return std::clamp(std::max(kVarianceScaleDecay * scale, scale * squared / 3.0), 1.0, kMaxVarianceScale);
}

void ScanTracker::calibrate_odometry(Time stamp, const Fix& before, const Pose2& T_odom_body, const Hypothesis& best) {
  if (!best.match) return;
  const Pose2 odometry = before.T_odom_body.inverse() * T_odom_body;
  const double seconds = std::max(0.0, to_seconds(stamp - before.stamp));
  const Eigen::Matrix3d motion = predict_motion(before.T_local_body, odometry, seconds, settings_.motion).covariance;
  const Eigen::Matrix3d matched =
      (motion.inverse() + tempering(best.log_likelihoods.size()) * best.match->information).inverse();
  const Eigen::Vector3d variance = (motion + matched).diagonal();
  correction_.update(odometry, before.T_local_body.inverse() * best.T_local_body,
                     {.std_m = std::sqrt(variance.head<2>().maxCoeff()), .std_rad = std::sqrt(variance.z())},
                     !degenerate_direction(best.match->information, kMinEvidenceRatio));
}

TrackedScan ScanTracker::to_tracked_scan(const Hypothesis& best, const PoseGaussian& prediction) const {
  TrackedScan tracked{.T_local_body = best.T_local_body, .submap = maps_.submap()};
  Eigen::Matrix3d information = prediction.covariance.inverse();
  if (best.match) {
    tracked.match_information = best.match->information;
    tracked.inlier_ratio = best.match->inlier_ratio;
    information += tempering(best.log_likelihoods.size()) * best.match->information;
  }
  tracked.covariance = information.inverse();
  return tracked;
}

bool ScanTracker::is_keyframe_due(const Pose2& T_local_body) const {
  const Pose2 T_keyframe_body = T_local_keyframe_.inverse() * T_local_body;
  return maps_.num_keyframes() < settings_.initial_keyframes ||
         T_keyframe_body.position().norm() >= settings_.keyframe_distance_m ||
         std::abs(T_keyframe_body.yaw) >= settings_.keyframe_angle_rad;
}

ScanTracker::Hypothesis ScanTracker::match_by_odometry(const std::vector<MatchPoint>& points,
                                                       const PoseGaussian& prediction) const {
  Hypothesis hypothesis =
      to_hypothesis(match_scan(maps_.older(), points, prediction.mean, prediction, settings_.matching), prediction);
  if (hypothesis.match) evaluate(hypothesis, points);
  return hypothesis;
}

// A wide prior keeps degenerate directions bounded when odometry has failed.
ScanTracker::Hypothesis ScanTracker::match_from(const Pose2& T_local_start, const std::vector<MatchPoint>& points,
                                                const PoseGaussian& prediction, const Hypothesis& best) const {
  const PoseGaussian prior{.mean = T_local_start, .covariance = 25.0 * prediction.covariance};
  return to_hypothesis(match_scan(maps_.older(), points, T_local_start, prior, settings_.matching,
                                  best.match ? &best.T_local_body : nullptr),
                       prediction);
}

ScanTracker::Hypothesis ScanTracker::to_hypothesis(const std::optional<MatchResult>& match,
                                                   const PoseGaussian& prediction) {
  Hypothesis hypothesis{.T_local_body = match ? match->T_map_body : prediction.mean, .match = match};
  if (match) hypothesis.log_prior = log_student_t(prediction, hypothesis.T_local_body);
  return hypothesis;
}

void ScanTracker::evaluate(Hypothesis& hypothesis, const std::vector<MatchPoint>& points) const {
  hypothesis.log_likelihoods =
      point_log_likelihoods(maps_.older(), points, hypothesis.T_local_body, settings_.matching);
}

// A smooth corridor matches anywhere along it: such a difference is left to odometry.
bool ScanTracker::is_determined_by_scan(const Hypothesis& a, const Hypothesis& b) {
  const Eigen::Vector3d offset(a.T_local_body.x - b.T_local_body.x, a.T_local_body.y - b.T_local_body.y,
                               wrap_angle(a.T_local_body.yaw - b.T_local_body.yaw));
  const Eigen::Vector3d determined = determined_offset(offset, a.match->information, kMinEvidenceRatio);
  return is_distinct({determined.x(), determined.y(), determined.z()}, {});
}

// The errors of neighboring points are correlated, those of distant points are not.
double ScanTracker::tempering(std::size_t num_points) const {
  return std::max(settings_.likelihood_tempering, 1.0 / (1.0 + static_cast<double>(num_points) / kIndependentPoints));
}

// A vehicle that passes has many points in few sectors, and they match best as if the robot moved with it.
bool ScanTracker::is_better(const Hypothesis& a, const Hypothesis& b, const std::vector<MatchPoint>& points) const {
  const SectorGains gains(points, a.log_likelihoods, b.log_likelihoods, usual_.unknown_log_likelihood());
  return gains.votes() > 0 && tempering(points.size()) * gains.total() + a.log_prior - b.log_prior > 0.0;
}

// Without the sectors in favor of a match that contradicts odometry and the majority of the sectors.
ScanTracker::Hypothesis ScanTracker::without_moving_objects(const Hypothesis& best,
                                                            const std::vector<MatchPoint>& points,
                                                            const PoseGaussian& prediction) const {
  if (squared_contradiction(prediction, best.T_local_body, *best.match) < kContradiction) return best;
  const SectorGains gains(points, best.log_likelihoods,
                          point_log_likelihoods(maps_.older(), points, prediction.mean, settings_.matching),
                          usual_.unknown_log_likelihood());
  if (gains.votes() > 0) return best;
  std::vector<MatchPoint> others = points;
  std::erase_if(others, [&](const MatchPoint& point) { return gains.vote(SectorGains::sector_of(point)) > 0; });
  return match_by_odometry(others, prediction);
}

void ScanTracker::integrate(TrackedScan& tracked) {
  pyramid_.reset();
  tracked.is_submap_start = maps_.integrate(tracked.scans, tracked.T_local_body, settings_);
  T_local_keyframe_ = tracked.T_local_body;
}

}  // namespace patrol::slam
