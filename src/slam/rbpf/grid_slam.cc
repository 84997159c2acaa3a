#include "slam/rbpf/grid_slam.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "core/error.h"
#include "core/particle_weights.h"
#include "slam/map_rendering.h"
#include "slam/particle_filter.h"
#include "slam/rbpf/particle_problem.h"

namespace patrol::slam {
namespace {

ParticleFilterComponents components_from(const GridSlamSettings& settings) {
  validate(settings, "slam.rbpf");
  if (settings.optimizer != "none" && settings.proposal != "motion") {
    throw InputError("slam.rbpf.optimizer = " + settings.optimizer +
                     ": must be none unless slam.rbpf.proposal = motion");
  }
  ParticleFilterSettings components = published_settings(settings.optimizer);
  components.resample_threshold = settings.resample_threshold;
  return make_components(components);
}

}  // namespace

GridSlam::GridSlam(const GridSlamSettings& settings, std::uint64_t seed, const Pose2& T_map_start)
    : settings_(settings),
      components_(components_from(settings)),
      proposal_noise_(seed, "slam/proposal"),
      resampling_noise_(seed, "slam/resampling"),
      T_map_last_(T_map_start) {
  particles_.push_back({.T_map_body = T_map_start, .map = GridMap(settings.resolution_m, settings.max_extent_m)});
}

SlamUpdate GridSlam::update(const LevelScan& scan, const Pose2& T_odom_body) {
  if (keyframes_ == 0) T_odom_last_ = T_odom_keyframe_ = T_odom_body, keyframe_stamp_ = scan.stamp;
  const bool is_level = scan.tilt_rad <= settings_.max_tilt_rad;
  std::vector<MatchPoint> points;
  if (is_level) points = downsample_scan(scan, settings_.matching.point_spacing_m, settings_.matching.max_points);

  gate_ranges(T_odom_body, scan.stamp);
  Proposal best = track(points, T_odom_body, scan.stamp);
  SlamUpdate update;
  update.is_keyframe = is_level && is_keyframe_due(best.posterior.mean);
  if (update.is_keyframe) {
    T_map_last_ = best.posterior.mean;
    const bool is_by_match = settings_.proposal == "scan_match" || particles_.size() == 1;
    const double tracked_inlier_ratio = best.inlier_ratio;
    best = is_by_match ? move_by_scan_match(points, T_odom_body, scan.stamp, update)
                       : move_by_odometry(points, T_odom_body, scan.stamp, update);
    if (!is_by_match) best.inlier_ratio = tracked_inlier_ratio;
    integrate(scan);
    T_odom_keyframe_ = T_odom_body, keyframe_stamp_ = scan.stamp;
    ranges_.clear();
  }

  T_map_last_ = update.T_map_body = best.posterior.mean;
  T_odom_last_ = T_odom_body;
  update.covariance = best.posterior.covariance;
  update.match_score = best.inlier_ratio;
  return update;
}

Proposal GridSlam::move_by_scan_match(const std::vector<MatchPoint>& points, const Pose2& T_odom_body, Time stamp,
                                      SlamUpdate& update) {
  const std::vector<Proposal> proposals = propose(points, T_odom_body, stamp);
  sample_particles(proposals);
  update.effective_sample_size = choose_best();
  const Proposal& best = proposals[best_];
  update.resampled = resample_if_needed(update.effective_sample_size);
  return best;
}

Proposal GridSlam::move_by_odometry(const std::vector<MatchPoint>& points, const Pose2& T_odom_body, Time stamp,
                                    SlamUpdate& update) {
  std::vector<PoseGaussian> predictions;
  std::vector<double> log_weights;
  for (const Particle& particle : particles_) {
    const Prediction prediction = predict(particle, T_odom_body, stamp);
    predictions.push_back(prediction.pose);
    log_weights.push_back(particle.log_weight + prediction.log_density);
  }
  RandomSequence random(proposal_noise_, keyframes_);
  RbpfParticleProblem step(particles_, predictions, points, settings_.likelihood_tempering, settings_.matching);
  propagate_and_weight(step, components_, random, log_weights);
  for (std::size_t i = 0; i < particles_.size(); ++i) particles_[i].log_weight = log_weights[i];

  update.effective_sample_size = choose_best();
  Proposal best{.posterior = {.mean = particles_[best_].T_map_body, .covariance = predictions[best_].covariance}};
  update.resampled = resample_if_depleted(step, components_, particles().weights, random, log_weights);
  for (std::size_t i = 0; i < particles_.size(); ++i) particles_[i].log_weight = log_weights[i];
  if (update.resampled) {
    // After resampling, the trajectory of the best particle continues in the nearest one.
    const auto distance_m = [&](const Particle& particle) {
      return (particle.T_map_body.position() - best.posterior.mean.position()).norm();
    };
    best_ = static_cast<std::size_t>(
        std::min_element(particles_.begin(), particles_.end(),
                         [&](const Particle& a, const Particle& b) { return distance_m(a) < distance_m(b); }) -
        particles_.begin());
  }
  return best;
}

GridSlam::Prediction GridSlam::predict(const Particle& particle, const Pose2& T_odom_body, Time stamp) const {
  Prediction prediction{.pose = predict_motion(particle.T_map_body, T_odom_keyframe_.inverse() * T_odom_body,
                                               to_seconds(stamp - keyframe_stamp_), settings_.motion)};
  prediction.log_density = update_with_ranges(ranges_, T_odom_body, settings_.ranges, prediction.pose);
  return prediction;
}

// Use the same ranges for all particles; otherwise particles that reject a range would be favored.
void GridSlam::gate_ranges(const Pose2& T_odom_body, Time stamp) {
  if (settings_.ranges.enabled) {
    for (const RangeMeasurement& measurement : new_ranges_) {
      const PoseGaussian pose = predict(particles_[best_], T_odom_body, stamp).pose;
      if (passes_gate(range_innovation(pose, T_odom_body, measurement, settings_.ranges), settings_.ranges)) {
        ranges_.push_back(measurement);
      }
    }
  }
  new_ranges_.clear();
}

// Returns the current pose of the best particle. If the match fails, odometry may have slipped: search a window.
Proposal GridSlam::track(const std::vector<MatchPoint>& points, const Pose2& T_odom_body, Time stamp) const {
  const Particle& particle = particles_[best_];
  const PoseGaussian prediction = predict(particle, T_odom_body, stamp).pose;
  const Pose2 T_map_start = T_map_last_ * (T_odom_last_.inverse() * T_odom_body);
  const auto match_from = [&](const Pose2& start) {
    return laplace_proposal(particle.map, points, start, prediction, settings_.likelihood_tempering,
                            settings_.matching);
  };
  Proposal tracked = match_from(T_map_start);
  if (tracked.inlier_ratio > 0.0 || points.empty() || !particle.map.has_surface()) return tracked;
  return match_from(search_pose(particle.map, points, T_map_start, settings_.matching));
}

bool GridSlam::is_keyframe_due(const Pose2& T_map_body) const {
  const bool is_start = keyframes_ < static_cast<std::uint64_t>(settings_.initial_keyframes);
  if (is_start || !particles_[best_].map.has_surface()) return true;
  const Pose2 T_keyframe_body = particles_[best_].T_map_body.inverse() * T_map_body;
  return T_keyframe_body.position().norm() >= settings_.keyframe_distance_m ||
         std::abs(T_keyframe_body.yaw) >= settings_.keyframe_angle_rad;
}

// The match of each particle starts from the best particle's motion since the keyframe, which is closer than odometry.
std::vector<Proposal> GridSlam::propose(const std::vector<MatchPoint>& points, const Pose2& T_odom_body,
                                        Time stamp) const {
  const Pose2 T_keyframe_body = particles_[best_].T_map_body.inverse() * T_map_last_;
  std::vector<Proposal> proposals;
  for (const Particle& particle : particles_) {
    const Prediction prediction = predict(particle, T_odom_body, stamp);
    proposals.push_back(laplace_proposal(particle.map, points, particle.T_map_body * T_keyframe_body, prediction.pose,
                                         settings_.likelihood_tempering, settings_.matching));
    proposals.back().log_weight_increment += prediction.log_density;
  }
  return proposals;
}

void GridSlam::sample_particles(const std::vector<Proposal>& proposals) {
  for (std::size_t i = 0; i < particles_.size(); ++i) {
    const auto unit = [&](std::uint64_t axis) { return proposal_noise_.normal(keyframes_, 3 * i + axis); };
    const bool is_sampled = particles_.size() > 1;
    particles_[i].T_map_body =
        is_sampled ? proposals[i].sample({unit(0), unit(1), unit(2)}) : proposals[i].posterior.mean;
    particles_[i].log_weight += proposals[i].log_weight_increment;
  }
}

// Selects the particle with the largest weight and returns the effective sample size.
double GridSlam::choose_best() {
  const ParticleSet set = particles();
  best_ = static_cast<std::size_t>(std::max_element(set.weights.begin(), set.weights.end()) - set.weights.begin());
  return effective_sample_size(set.weights);
}

bool GridSlam::resample_if_needed(double num_effective) {
  if (num_effective >= settings_.resample_threshold * static_cast<double>(particles_.size())) return false;
  const std::vector<std::size_t> parents =
      systematic_parents(particles().weights, resampling_noise_.uniform(keyframes_));
  std::vector<Particle> children;
  for (const std::size_t parent : parents) {
    children.push_back(particles_[parent]);
    children.back().log_weight = 0.0;
  }
  // The particle with the largest weight has at least one child, because its weight is at least 1 / N.
  best_ = static_cast<std::size_t>(std::find(parents.begin(), parents.end(), best_) - parents.begin());
  particles_ = std::move(children);
  return true;
}

// Until the initial keyframes are mapped there is a single particle; it is then copied.
void GridSlam::integrate(const LevelScan& scan) {
  for (Particle& particle : particles_) {
    integrate_scan(scan, particle.T_map_body, settings_.integration, particle.map);
    particle.path = std::make_shared<TrajectoryNode>(particle.T_map_body, particle.path);
  }
  ++keyframes_;
  if (keyframes_ == static_cast<std::uint64_t>(settings_.initial_keyframes)) {
    const Particle first = particles_.front();
    particles_.assign(static_cast<std::size_t>(settings_.particles), first);
  }
}

OccupancyGrid GridSlam::map() const {
  return render_map(particles_[best_].map, settings_.min_hits_occupied, settings_.min_occupied_hit_ratio);
}

std::vector<Pose2> GridSlam::best_path() const {
  std::vector<Pose2> T_map_body;
  for (const TrajectoryNode* step = particles_[best_].path.get(); step; step = step->before.get())
    T_map_body.push_back(step->T_map_body);
  std::reverse(T_map_body.begin(), T_map_body.end());
  return T_map_body;
}

ParticleSet GridSlam::particles() const {
  ParticleSet set;
  set.stamp = keyframe_stamp_;
  std::vector<double> log_weights;
  for (const Particle& particle : particles_) {
    set.T_map_body.push_back(particle.T_map_body);
    log_weights.push_back(particle.log_weight);
  }
  set.weights = normalized_weights(log_weights);
  return set;
}

}  // namespace patrol::slam
