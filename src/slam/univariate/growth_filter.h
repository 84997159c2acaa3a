#pragma once

#include <cstdint>
#include <vector>

#include "core/random.h"
#include "slam/particle_filter_parts.h"
#include "slam/univariate/growth_model.h"
#include "slam/univariate/univariate_filter.h"

namespace patrol::slam {

/// Particle filters of the growth model on the common core: the bootstrap filter (Gordon, Salmond, Smith 1993), or with an optimiser the swarm
/// filters of paper 001, section 2. A particle's position is its state itself. An optimiser improves on the likelihood, which -x has as x does, and
/// the weight after its move is the likelihood again: as the papers have it, what was known before is forgotten wherever particles are moved far.
/// The estimate is the weighted mean before resampling.
class GrowthFilter : public UnivariateFilter {
 public:
  /// Throws InputError for less than one particle.
  GrowthFilter(int particles, const GrowthModel& model, ParticleFilterParts parts, std::uint64_t seed);

  UnivariateEstimate step(double observation) override;

  /// [particle], as of before the last resampling.
  const std::vector<double>& states() const { return states_; }
  const std::vector<double>& weights() const { return weights_; }

 private:
  class Step;

  GrowthModel model_;
  ParticleFilterParts parts_;
  RandomStream draws_;
  int steps_ = 0;
  std::vector<double> particles_, log_weights_;
  std::vector<double> states_, weights_;
};

/// IFA-PF as paper 001, section 2, sets it: beta_0 = gamma = 1, one generation a step, stepwise resampling at every step with beta = 0.8 and
/// mu = 0.01 (the defaults of StepwiseResampling).
ParticleFilterSettings ifa_settings_of_paper();

}  // namespace patrol::slam
