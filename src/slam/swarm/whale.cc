#include "slam/swarm/whale.h"

#include <cmath>
#include <numbers>

namespace patrol::slam {

void WhaleOptimizer::move(Swarm& swarm, const Fitness& fitness_of, RandomSequence& random) const {
  for (int iteration = 0; iteration < iterations_; ++iteration) {
    const double a = 2.0 - 2.0 * iteration / iterations_;
    const Position best = swarm.positions[swarm.best()];
    for (std::size_t i = 0; i < swarm.size(); ++i) {
      const Position& whale = swarm.positions[i];
      Position candidate;
      if (random.uniform() < 0.5) {
        const double A = 2.0 * a * random.uniform() - a, C = 2.0 * random.uniform();
        const Position leader = std::abs(A) < 1.0 ? best : swarm.positions[random.index(swarm.size())];
        candidate = leader - A * (C * leader - whale).cwiseAbs();
      } else {
        const double l = 2.0 * random.uniform() - 1.0;
        candidate = (best - whale).cwiseAbs() * std::exp(l) * std::cos(2.0 * std::numbers::pi * l) + best;
      }
      swarm.accept(i, candidate, fitness_of);
    }
  }
}

}  // namespace patrol::slam
