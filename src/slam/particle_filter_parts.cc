#include "slam/particle_filter_parts.h"

#include "slam/swarm/bat.h"
#include "slam/swarm/firefly.h"
#include "slam/swarm/sand_cat.h"
#include "slam/swarm/whale.h"

namespace patrol::slam {
namespace {

std::shared_ptr<const SwarmOptimizer> make_optimizer(const ParticleFilterSettings& settings) {
  const std::string& name = settings.optimizer;
  const int iterations = settings.optimizer_iterations;
  if (name == "woa") return std::make_shared<WhaleOptimizer>(iterations);
  if (name == "ba") return std::make_shared<BatOptimizer>(BatSettings{.iterations = iterations});
  if (name == "fa") return std::make_shared<FireflyOptimizer>(FireflySettings{.iterations = iterations, .absorption = settings.firefly_absorption});
  if (name == "ifa") {
    return std::make_shared<ImprovedFireflyOptimizer>(ImprovedFireflySettings{.iterations = iterations, .absorption = settings.firefly_absorption});
  }
  if (name == "scso" || name == "iscso") return std::make_shared<SandCatOptimizer>(iterations, name == "iscso");
  return nullptr;
}

Resampler make_resampler(const std::string& name) {
  if (name == "multinomial") return resample_multinomially;
  if (name == "residual") return resample_by_residuals;
  if (name == "low_weight") return draw_low_weights_up;
  if (name == "stepwise") return [](const std::vector<double>& weights, RandomSequence& random) { return resample_stepwise(weights, random); };
  return resample_evenly;
}

}  // namespace

ParticleFilterSettings settings_of_paper(const std::string& optimizer) {
  ParticleFilterSettings settings{.optimizer = optimizer};
  if (optimizer == "iscso") settings.resampler = "low_weight";
  if (optimizer == "ifa") settings.resampler = "stepwise";
  return settings;
}

ParticleFilterParts make_parts(const ParticleFilterSettings& settings) {
  validate(settings, "particle_filter");
  return {.optimizer = make_optimizer(settings), .resample = make_resampler(settings.resampler), .resample_threshold = settings.resample_threshold};
}

}  // namespace patrol::slam
