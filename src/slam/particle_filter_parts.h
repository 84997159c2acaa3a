#pragma once

#include <memory>
#include <string>

#include "core/settings.h"
#include "slam/resampler.h"
#include "slam/swarm/swarm.h"

namespace patrol::slam {

/// Names of the swarm optimizers. woa: whale, ba: bat, fa: firefly, ifa: improved firefly, scso: sand cat, iscso:
/// improved sand cat.
inline Limits optimizer_names() { return one_of({"none", "woa", "ba", "fa", "ifa", "scso", "iscso"}); }

/// Names and parameters of the interchangeable components of a particle filter.
struct ParticleFilterSettings {
  std::string optimizer = "none";
  int optimizer_iterations = 5;
  double firefly_absorption = 0.01;       ///< gamma, per square of the unit of the positions
  std::string resampler = "systematic";
  /// Resample if the effective sample size is below this fraction of the number of particles.
  double resample_threshold = 0.5;

  template <typename Self, typename Visitor>
  static void fields(Self& self, Visitor& visit) {
    visit("optimizer", self.optimizer, optimizer_names());
    visit("optimizer_iterations", self.optimizer_iterations, between(1, 1000));
    visit("firefly_absorption", self.firefly_absorption, at_least(0.0));
    visit("resampler", self.resampler, one_of({"multinomial", "systematic", "residual", "low_weight", "stepwise"}));
    visit("resample_threshold", self.resample_threshold, between(0.0, 1.0));
  }
};

/// Optimizer with the resampler of its source: low-weight optimization for ISCSO [Wu25], stepwise resampling for IFA
/// [Cui21], systematic resampling for all others.
ParticleFilterSettings settings_of_paper(const std::string& optimizer);

struct ParticleFilterParts {
  std::shared_ptr<const SwarmOptimizer> optimizer;  ///< null: particles keep the sampled positions
  Resampler resample = resample_evenly;
  double resample_threshold = 0.5;
};

/// Throws InputError if a setting is invalid.
ParticleFilterParts make_parts(const ParticleFilterSettings& settings);

}  // namespace patrol::slam
