#pragma once

#include <cstdint>
#include <vector>

#include "core/random.h"
#include "slam/particle_filter_components.h"
#include "studies/univariate/growth_model.h"
#include "studies/univariate/univariate_filter.h"

namespace patrol::studies {

/// Particle filters of the growth model: the bootstrap filter [Gordon93] or, with an optimizer, the swarm filters of
/// [Cui21, section 2]. The position of a particle is its state. The optimizer maximizes the likelihood, which is equal
/// for x and -x, and the weight after its move is the likelihood, as in [Cui21]. Moving particles far thus discards the
/// prior. The estimate is the weighted mean before resampling.
class GrowthFilter : public UnivariateFilter {
 public:
  /// Throws InputError for less than one particle.
  GrowthFilter(int particles, const GrowthModel& model, slam::ParticleFilterComponents components, std::uint64_t seed);

  UnivariateEstimate step(double observation) override;

  /// Particles before the last resampling, [particle].
  const std::vector<double>& states() const { return states_; }
  const std::vector<double>& weights() const { return weights_; }

 private:
  class Step;

  GrowthModel model_;
  slam::ParticleFilterComponents components_;
  RandomStream random_;
  int steps_ = 0;
  std::vector<double> particles_, log_weights_;
  std::vector<double> states_, weights_;
};

/// Settings of IFA-PF in [Cui21, section 2]: beta_0 = gamma = 1, one generation per step, stepwise resampling at every
/// step. The latter has the defaults of StepwiseResampling, beta = 0.8 and mu = 0.01.
slam::ParticleFilterSettings published_ifa_settings();

}  // namespace patrol::studies
