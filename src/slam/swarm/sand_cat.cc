#include "slam/swarm/sand_cat.h"

#include <cmath>
#include <numbers>

namespace patrol::slam {
namespace {

/// Cauchy mutation of each coordinate [Wu25, eq. 1].
Position mutated(Position position, RandomSequence& random) {
  for (double& coordinate : position) coordinate += coordinate * random.cauchy();
  return position;
}

}  // namespace

void SandCatOptimizer::move(Swarm& swarm, const Fitness& fitness_of, RandomSequence& random) const {
  for (int iteration = 0; iteration < iterations_; ++iteration) {
    const Swarm before = swarm;
    search_and_attack(iteration, swarm, fitness_of, random);
    if (!is_improved_) continue;
    const std::size_t best = swarm.best();
    swarm.accept(best, mutated(swarm.positions[best], random), fitness_of);
    replace_worst(iteration + 1, before, swarm, fitness_of);
  }
}

void SandCatOptimizer::search_and_attack(int iteration, Swarm& swarm, const Fitness& fitness_of,
                                         RandomSequence& random) const {
  const double sensitivity = 2.0 - 2.0 * iteration / iterations_;  // r_G
  const Position best = swarm.positions[swarm.best()];
  for (std::size_t i = 0; i < swarm.size(); ++i) {
    const Position& cat = swarm.positions[i];
    const double r = sensitivity * random.uniform();
    const double R = 2.0 * sensitivity * random.uniform() - sensitivity;
    Position candidate;
    if (std::abs(R) <= 1.0) {
      const Position distance = (random.uniform() * best - cat).cwiseAbs();
      candidate = best - r * std::cos(2.0 * std::numbers::pi * random.uniform()) * distance;
    } else {
      candidate = r * (best - random.uniform() * cat);
    }
    swarm.accept(i, candidate, fitness_of);
  }
}

void SandCatOptimizer::replace_worst(int iteration, const Swarm& before, Swarm& swarm,
                                     const Fitness& fitness_of) const {
  const double replaced_fraction = std::sin(std::numbers::pi * iteration / (2.0 * iterations_));
  const auto num_kept = static_cast<std::size_t>(std::ceil(static_cast<double>(swarm.size() - 1) * replaced_fraction));
  const std::vector<std::size_t> old_ranking = before.ranking(), ranking = swarm.ranking();
  for (std::size_t i = 0; i < num_kept; ++i)
    swarm.accept(ranking[ranking.size() - 1 - i], before.positions[old_ranking[i]], fitness_of);
}

}  // namespace patrol::slam
