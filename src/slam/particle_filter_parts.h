#pragma once

#include <memory>
#include <string>

#include "core/settings.h"
#include "slam/resampler.h"
#include "slam/swarm/swarm.h"

namespace patrol::slam {

/// woa: whale, ba: bat, fa: firefly, ifa: improved firefly, scso: sand cat, iscso: improved sand cat.
inline Limits optimizer_names() { return one_of({"none", "woa", "ba", "fa", "ifa", "scso", "iscso"}); }

/// The interchangeable parts of a particle filter, by name.
struct ParticleFilterSettings {
  std::string optimizer = "none";
  int optimizer_iterations = 5;
  double firefly_absorption = 0.01;       ///< gamma, per square of the positions' unit
  std::string resampler = "systematic";
  double resample_threshold = 0.5;        ///< when the effective sample size falls below this share of the particles

  template <typename Self, typename Visitor>
  static void fields(Self& self, Visitor& visit) {
    visit("optimizer", self.optimizer, optimizer_names());
    visit("optimizer_iterations", self.optimizer_iterations, between(1, 1000));
    visit("firefly_absorption", self.firefly_absorption, at_least(0.0));
    visit("resampler", self.resampler, one_of({"multinomial", "systematic", "residual", "low_weight", "stepwise"}));
    visit("resample_threshold", self.resample_threshold, between(0.0, 1.0));
  }
};

/// An optimiser with the resampler that its paper gives it: ISCSO low-weight optimisation (paper 000), IFA stepwise (paper 001), all others systematic.
ParticleFilterSettings settings_of_paper(const std::string& optimizer);

struct ParticleFilterParts {
  std::shared_ptr<const SwarmOptimizer> optimizer;  ///< none: particles stay where they were drawn
  Resampler resample = resample_evenly;
  double resample_threshold = 0.5;
};

/// Throws InputError if a setting breaks its rule.
ParticleFilterParts make_parts(const ParticleFilterSettings& settings);

}  // namespace patrol::slam
