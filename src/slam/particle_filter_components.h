#pragma once

#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "core/settings.h"
#include "slam/resampling.h"
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

/// Names and parameters of the interchangeable components of a particle filter.
struct ParticleFilterSettings {
  std::string optimizer = "none";
  int optimizer_iterations = 5;
  double firefly_absorption = 0.01;  ///< gamma, per square of the unit of the positions
  std::string resampler = "systematic";
  /// Resample if the effective sample size is below this fraction of the number of particles.
  double resample_threshold = 0.5;

  template <typename Self, typename Visitor>
  static void fields(Self& self, Visitor& visit) {
    visit("optimizer", self.optimizer, one_of(optimizers()));
    visit("optimizer_iterations", self.optimizer_iterations, between(1, 1000));
    visit("firefly_absorption", self.firefly_absorption, at_least(0.0));
    visit("resampler", self.resampler, one_of(resamplers()));
    visit("resample_threshold", self.resample_threshold, between(0.0, 1.0));
  }
};

/// Optimizer with the resampler of its source: low-weight optimization for ISCSO [Wu25], stepwise resampling for IFA
/// [Cui21], systematic resampling for all others.
ParticleFilterSettings published_settings(const std::string& optimizer);

struct ParticleFilterComponents {
  std::shared_ptr<const SwarmOptimizer> optimizer;  ///< null: particles keep the sampled positions
  Resampler resample = resample_systematic;
  double resample_threshold = 0.5;
};

/// Throws InputError if a setting is invalid.
ParticleFilterComponents make_components(const ParticleFilterSettings& settings);

}  // namespace patrol::slam
