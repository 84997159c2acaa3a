#pragma once

#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "core/settings.h"
#include "slam/resampler.h"
#include "slam/swarm/swarm.h"

namespace patrol::slam {

struct ParticleFilterSettings;

/// Row of the table of optimizers that move particles toward a higher likelihood.
struct OptimizerRow {
  std::string_view name;       ///< text in settings
  std::string_view summary;    ///< one line of documentation
  std::string_view resampler;  ///< the one that its publication combines it with
  std::shared_ptr<const SwarmOptimizer> (*make)(const ParticleFilterSettings& settings);
};

/// Row of the table of resamplers.
struct ResamplerRow {
  std::string_view name;     ///< text in settings
  std::string_view summary;  ///< one line of documentation
  std::vector<Offspring> (*resample)(const std::vector<double>& weights, RandomSequence& random);
};

std::span<const OptimizerRow> optimizers();
std::span<const ResamplerRow> resamplers();

/// The interchangeable parts of a particle filter, by name.
struct ParticleFilterSettings {
  std::string optimizer = "none";
  int optimizer_iterations = 5;
  double firefly_absorption = 0.01;       ///< gamma, per square of the positions' unit
  std::string resampler = "systematic";
  double resample_threshold = 0.5;        ///< when the effective sample size falls below this share of the particles

  template <typename Self, typename Visitor>
  static void fields(Self& self, Visitor& visit) {
    visit("optimizer", self.optimizer, one_of(optimizers()));
    visit("optimizer_iterations", self.optimizer_iterations, between(1, 1000));
    visit("firefly_absorption", self.firefly_absorption, at_least(0.0));
    visit("resampler", self.resampler, one_of(resamplers()));
    visit("resample_threshold", self.resample_threshold, between(0.0, 1.0));
  }
};

/// An optimizer with the resampler of its publication. Throws InputError for an unknown optimizer.
ParticleFilterSettings settings_of_paper(const std::string& optimizer);

struct ParticleFilterParts {
  std::shared_ptr<const SwarmOptimizer> optimizer;  ///< none: particles stay where they were drawn
  Resampler resample = resample_evenly;
  double resample_threshold = 0.5;
};

/// Throws InputError if a setting breaks its rule.
ParticleFilterParts make_parts(const ParticleFilterSettings& settings);

}  // namespace patrol::slam
