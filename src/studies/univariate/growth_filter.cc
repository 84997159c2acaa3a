#include "studies/univariate/growth_filter.h"

#include <cmath>
#include <cstddef>
#include <utility>

#include <fmt/format.h>

#include "core/error.h"
#include "slam/particle_filter.h"

namespace patrol::studies {

/// Particles at one step, as a ParticleProblem.
class GrowthFilter::Step {
 public:
  Step(GrowthFilter& filter, double observation)
      : filter_(filter),
        observation_(observation),
        forcing_(GrowthModel::forcing(filter.steps_)),
        process_std_(std::sqrt(filter.model_.settings().process_var)) {}

  std::size_t size() const { return filter_.particles_.size(); }

  slam::Position sample(std::size_t i, RandomSequence& random) const {
    return slam::Position::Constant(1, filter_.model_.drift(filter_.particles_[i]) + forcing_ +
                                           process_std_ * random.normal());
  }

  double log_fitness(std::size_t, const slam::Position& position) const {
    return filter_.model_.log_likelihood(observation_, position[0]);
  }

  double commit(std::size_t i, const slam::Position& position) {
    filter_.particles_[i] = position[0];
    return filter_.model_.log_likelihood(observation_, position[0]);
  }

  void apply_resampling(const std::vector<slam::Offspring>& offspring) {
    std::vector<double> children;
    children.reserve(offspring.size());
    for (const slam::Offspring& child : offspring) {
      const double own = filter_.particles_[child.parent], other = filter_.particles_[child.attractor];
      children.push_back((1.0 + child.mutation) * (own + child.attraction * (other - own)));
    }
    filter_.particles_ = std::move(children);
  }

 private:
  GrowthFilter& filter_;
  double observation_, forcing_, process_std_;
};

GrowthFilter::GrowthFilter(int particles, const GrowthModel& model, slam::ParticleFilterComponents components,
                           std::uint64_t seed)
    : model_(model), components_(std::move(components)), random_(seed, "slam/univariate/particles") {
  if (particles < 1) throw InputError(fmt::format("growth_filter.particles = {}: must be at least 1", particles));
  particles_.assign(static_cast<std::size_t>(particles), model.settings().initial_state);
  log_weights_.assign(particles_.size(), 0.0);
}

UnivariateEstimate GrowthFilter::step(double observation) {
  ++steps_;
  RandomSequence random(random_, static_cast<std::uint64_t>(steps_));
  Step problem(*this, observation);
  propagate_and_weight(problem, components_, random, log_weights_);
  weights_ = normalized_weights(log_weights_);
  states_ = particles_;
  resample_if_depleted(problem, components_, weights_, random, log_weights_);
  return summarize(states_, weights_);
}

slam::ParticleFilterSettings published_ifa_settings() {
  return {.optimizer = "ifa",
          .optimizer_iterations = 1,
          .firefly_absorption = 1.0,
          .resampler = "stepwise",
          .resample_threshold = 1.0};
}

}  // namespace patrol::studies
