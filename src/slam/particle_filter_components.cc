#include "slam/particle_filter_components.h"

#include <array>

#include "core/named_table.h"
#include "slam/swarm/bat.h"
#include "slam/swarm/firefly.h"
#include "slam/swarm/sand_cat.h"
#include "slam/swarm/whale.h"

namespace patrol::slam {
namespace {

using Settings = ParticleFilterSettings;
using Optimizer = std::shared_ptr<const SwarmOptimizer>;

Optimizer make_improved_firefly(const Settings& s) {
  return std::make_shared<ImprovedFireflyOptimizer>(
      ImprovedFireflySettings{.iterations = s.optimizer_iterations, .absorption = s.firefly_absorption});
}

constexpr std::array kOptimizers = std::to_array<OptimizerRow>({
    {"none", "Particles stay where the proposal drew them", "systematic",
     [](const Settings&) -> Optimizer { return nullptr; }},
    {"woa", "Whale optimization", "systematic",
     [](const Settings& s) -> Optimizer { return std::make_shared<WhaleOptimizer>(s.optimizer_iterations); }},
    {"ba", "Bat algorithm", "systematic",
     [](const Settings& s) -> Optimizer {
       return std::make_shared<BatOptimizer>(BatSettings{.iterations = s.optimizer_iterations});
     }},
    {"fa", "Firefly algorithm", "systematic",
     [](const Settings& s) -> Optimizer {
       return std::make_shared<FireflyOptimizer>(
           FireflySettings{.iterations = s.optimizer_iterations, .absorption = s.firefly_absorption});
     }},
    {"ifa", "Improved firefly algorithm of [Cui21], with its stepwise resampling", "stepwise", make_improved_firefly},
    {"scso", "Sand cat swarm optimization", "systematic",
     [](const Settings& s) -> Optimizer { return std::make_shared<SandCatOptimizer>(s.optimizer_iterations, false); }},
    {"iscso", "Improved sand cat swarm optimization of [Wu25], with its low-weight optimization", "low_weight",
     [](const Settings& s) -> Optimizer { return std::make_shared<SandCatOptimizer>(s.optimizer_iterations, true); }},
});

constexpr std::array kResamplers = std::to_array<ResamplerRow>({
    {"multinomial", "One independent sample for each new particle", resample_multinomial},
    {"systematic", "One random offset for all new particles, at equal steps of the cumulative weight",
     resample_systematic},
    {"residual", "Integer parts of the expected counts for certain, the rest sampled", resample_residual},
    {"low_weight", "Low-weight optimization of [Wu25]; biased", optimize_low_weights},
    {"stepwise", "Stepwise resampling of [Cui21]; biased",
     [](const std::vector<double>& weights, RandomSequence& random) { return resample_stepwise(weights, random); }},
});

}  // namespace

std::span<const OptimizerRow> optimizers() { return kOptimizers; }

std::span<const ResamplerRow> resamplers() { return kResamplers; }

ParticleFilterSettings published_settings(const std::string& optimizer) {
  return {.optimizer = optimizer, .resampler = std::string(row_named(kOptimizers, optimizer, "optimizer").resampler)};
}

ParticleFilterComponents make_components(const ParticleFilterSettings& settings) {
  validate(settings, "particle_filter");
  return {.optimizer = row_named(kOptimizers, settings.optimizer, "optimizer").make(settings),
          .resample = row_named(kResamplers, settings.resampler, "resampler").resample,
          .resample_threshold = settings.resample_threshold};
}

}  // namespace patrol::slam
