#include "studies/landmarks/fast_slam.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include <Eigen/Cholesky>
#include <Eigen/LU>

#include "core/geometry/linear_algebra.h"
#include "slam/particle_filter.h"

namespace patrol::studies {

/// Particles at one step, as a ParticleProblem.
class FastSlam::Step {
 public:
  Step(FastSlam& slam, const Control& control, const std::vector<RangeBearing>& observations)
      : slam_(slam), control_(control), observations_(observations) {
    for (Particle& particle : slam_.particles_) {
      particle.T_map_before = particle.T_map_body;
      if (matches_.empty() || !slam_.settings_.association.is_known) {
        const Pose2 expected = slam_.motion_.move_with_noise(particle.T_map_before, control_, particle.bias.mean);
        matches_.push_back(associate(particle.map, expected, observations_, slam_.noise_, slam_.settings_.association));
      }
      if (slam_.settings_.use_optimal_proposal)
        proposals_.push_back(slam_.propose(particle, control_, observations_, matches_.back()));
    }
  }

  std::size_t size() const { return slam_.particles_.size(); }

  slam::Position sample(std::size_t i, RandomSequence& random) const {
    const double first = random.normal();
    const Eigen::Vector2d unit(first, random.normal());
    if (slam_.settings_.use_optimal_proposal) return proposals_[i].mean + proposals_[i].root * unit;
    const OdometryBias& bias = slam_.particles_[i].bias;
    return bias.mean + bias.increment_root() * unit;
  }

  double log_fitness(std::size_t i, const slam::Position& position) const {
    const Particle& particle = slam_.particles_[i];
    const double likelihood = slam_.log_likelihood(particle, pose_at(particle, position), observations_, matches(i));
    return slam_.settings_.prior_weight > 0.0
               ? likelihood + slam_.settings_.prior_weight * log_prior(particle, position)
               : likelihood;
  }

  double commit(std::size_t i, const slam::Position& position) {
    Particle& particle = slam_.particles_[i];
    particle.T_map_body = pose_at(particle, position);
    particle.increment = position;
    double log_weight = 0.0;
    const std::vector<int>& numbers = matches(i);
    for (std::size_t k = 0; k < observations_.size(); ++k) {
      if (numbers[k] != kUnmatched)
        log_weight += particle.map.update(numbers[k], particle.T_map_body, observations_[k], slam_.noise_);
    }
    if (slam_.settings_.use_optimal_proposal) {
      const Eigen::Vector2d unit =
          proposals_[i].root.triangularView<Eigen::Lower>().solve(position - proposals_[i].mean);
      log_weight += log_prior(particle, position) - (proposals_[i].log_normalizer - 0.5 * unit.squaredNorm());
    }
    if (slam_.settings_.bias.std > 0.0) particle.bias.add_increment(position, slam_.settings_.bias);
    return log_weight;
  }

  void apply_resampling(const std::vector<slam::Offspring>& offspring) { slam_.apply_resampling(control_, offspring); }

 private:
  const std::vector<int>& matches(std::size_t i) const { return matches_[matches_.size() == 1 ? 0 : i]; }

  Pose2 pose_at(const Particle& particle, const slam::Position& position) const {
    return slam_.motion_.move_with_noise(particle.T_map_before, control_, position);
  }

  static double log_prior(const Particle& particle, const slam::Position& position) {
    const Eigen::Matrix2d covariance = particle.bias.increment_covariance();
    const Eigen::Vector2d offset = position - particle.bias.mean;
    return -0.5 * (offset.dot(covariance.inverse() * offset) + std::log(covariance.determinant()));
  }

  FastSlam& slam_;
  const Control& control_;
  const std::vector<RangeBearing>& observations_;
  std::vector<std::vector<int>> matches_;  ///< [particle][observation]; only one row with known association
  std::vector<Proposal> proposals_;        ///< [particle], for FastSLAM 2.0
};

FastSlam::FastSlam(const FastSlamSettings& settings, ControlMotion motion, const RangeBearingNoise& noise,
                   slam::ParticleFilterComponents components, std::uint64_t seed)
    : settings_(settings),
      motion_(std::move(motion)),
      noise_(noise),
      components_(std::move(components)),
      random_(seed, "slam/landmarks/particles") {
  motion_.std *= settings_.noise_scale;
  const auto num = static_cast<std::size_t>(settings_.particles);
  particles_.assign(num, {.T_map_body = {},
                          .T_map_before = {},
                          .increment = Eigen::Vector2d::Zero(),
                          .bias = OdometryBias(settings_.bias),
                          .map = {}});
  log_weights_.assign(num, 0.0);
}

LandmarkSlamEstimate FastSlam::step(const Control& control, const std::vector<RangeBearing>& observations) {
  RandomSequence random(random_, steps_++);
  Step problem(*this, control, observations);
  propagate_and_weight(problem, components_, random, log_weights_);
  weights_ = normalized_weights(log_weights_);
  poses_.clear();
  for (const Particle& particle : particles_) poses_.push_back(particle.T_map_body);
  LandmarkSlamEstimate estimate = summary();
  estimate.is_resampled = resample_if_depleted(problem, components_, weights_, random, log_weights_);
  return estimate;
}

double FastSlam::log_likelihood(const Particle& particle, const Pose2& T_map_body,
                                const std::vector<RangeBearing>& observations, const std::vector<int>& matches) const {
  ObservationLikelihood likelihood(T_map_body, noise_);
  for (std::size_t k = 0; k < observations.size(); ++k) {
    if (matches[k] != kUnmatched && particle.map.has(matches[k]))
      likelihood.add(particle.map.at(matches[k]), observations[k]);
  }
  return likelihood.log_density();
}

// Gauss-Newton from the odometry prediction; newly observed landmarks do not constrain the pose.
FastSlam::Proposal FastSlam::propose(const Particle& particle, const Control& control,
                                     const std::vector<RangeBearing>& observations,
                                     const std::vector<int>& matches) const {
  constexpr int kIterations = 2;
  const Eigen::Matrix2d prior_information = particle.bias.increment_covariance().inverse();
  Eigen::Vector2d mean = particle.bias.mean;
  Eigen::Matrix2d information = prior_information;
  for (int iteration = 0; iteration < kIterations; ++iteration) {
    const Control corrected = control + motion_.std.cwiseProduct(mean);
    const Pose2 pose = motion_.move(particle.T_map_before, corrected);
    const Eigen::Matrix<double, 3, 2> d_by_increment =
        jacobian_of(motion_, particle.T_map_before, corrected).control * motion_.std.asDiagonal();
    information = prior_information;
    Eigen::Vector2d gradient = prior_information * (particle.bias.mean - mean);
    for (std::size_t k = 0; k < observations.size(); ++k) {
      if (matches[k] == kUnmatched || !particle.map.has(matches[k])) continue;
      const LandmarkInnovation fit = landmark_innovation(pose, particle.map.at(matches[k]), observations[k], noise_);
      const Eigen::Matrix2d J = fit.H_pose() * d_by_increment;
      const Eigen::Matrix2d S_inverse = fit.S_inverse();
      information += J.transpose() * S_inverse * J;
      gradient += J.transpose() * S_inverse * fit.innovation();
    }
    mean += information.inverse() * gradient;
  }
  const Eigen::Matrix2d root = cholesky_factor(Eigen::Matrix2d(information.inverse()));
  return {.mean = mean, .root = root, .log_normalizer = -std::log(root(0, 0) * root(1, 1))};
}

// A particle that is attracted toward another one takes the other's trajectory and map, and a fraction of its last
// increment. Maps cannot be interpolated.
void FastSlam::apply_resampling(const Control& control, const std::vector<slam::Offspring>& offspring) {
  std::vector<Particle> children;
  children.reserve(offspring.size());
  for (const slam::Offspring& child : offspring) {
    const bool is_attracted = child.attraction > 0.0;
    Particle& particle = children.emplace_back(particles_[is_attracted ? child.attractor : child.parent]);
    if (!is_attracted && child.mutation == 0.0) continue;
    const slam::Position own = particles_[child.parent].increment;
    particle.increment = (1.0 + child.mutation) * (own + child.attraction * (particle.increment - own));
    particle.T_map_body = motion_.move_with_noise(particle.T_map_before, control, particle.increment);
  }
  particles_ = std::move(children);
}

LandmarkSlamEstimate FastSlam::summary() const {
  LandmarkSlamEstimate estimate;
  Eigen::Vector2d position = Eigen::Vector2d::Zero(), direction = Eigen::Vector2d::Zero();
  for (std::size_t i = 0; i < particles_.size(); ++i) {
    const Pose2& pose = particles_[i].T_map_body;
    position += weights_[i] * pose.position();
    direction += weights_[i] * Eigen::Vector2d(std::cos(pose.yaw), std::sin(pose.yaw));
  }
  estimate.T_map_body = {position.x(), position.y(), std::atan2(direction.y(), direction.x())};
  for (std::size_t i = 0; i < particles_.size(); ++i) {
    Eigen::Vector3d offset = particles_[i].T_map_body.vector() - estimate.T_map_body.vector();
    offset.z() = wrap_angle(offset.z());
    estimate.covariance += weights_[i] * offset * offset.transpose();
  }
  estimate.effective_sample_size = effective_sample_size(weights_);
  return estimate;
}

// With known association, index i is the same landmark in all particles: return the weighted mean. Otherwise return the
// landmarks of the particle with the largest weight.
std::vector<std::optional<Eigen::Vector2d>> FastSlam::landmarks() const {
  const std::vector<double> weights = normalized_weights(log_weights_);
  const std::size_t best = static_cast<std::size_t>(std::max_element(weights.begin(), weights.end()) - weights.begin());
  std::vector<std::optional<Eigen::Vector2d>> means(particles_[best].map.landmarks().size());
  for (std::size_t i = 0; i < means.size(); ++i) {
    if (!particles_[best].map.has(static_cast<int>(i))) continue;
    means[i] = particles_[best].map.landmarks()[i].mean_m;
    if (!settings_.association.is_known) continue;
    means[i]->setZero();
    for (std::size_t p = 0; p < particles_.size(); ++p)
      *means[i] += weights[p] * particles_[p].map.landmarks()[i].mean_m;
  }
  return means;
}

}  // namespace patrol::studies
