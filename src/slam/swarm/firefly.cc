#include "slam/swarm/firefly.h"

#include <cmath>

namespace patrol::slam {
namespace {

/// Attraction beta_0 exp(-gamma r^2) (x_j - x_i) from one position toward another.
Position attraction_step(const Position& from, const Position& to, double attractiveness, double absorption) {
  return attractiveness * std::exp(-absorption * (to - from).squaredNorm()) * (to - from);
}

void add_random_step(Position& position, double step, RandomSequence& random) {
  for (double& coordinate : position) coordinate += step * (random.uniform() - 0.5);
}

}  // namespace

void FireflyOptimizer::move(Swarm& swarm, const Fitness& fitness_of, RandomSequence& random) const {
  for (int iteration = 0; iteration < settings_.iterations; ++iteration) {
    const Swarm before = swarm;
    const std::vector<std::size_t> ranking = before.ranking();
    for (std::size_t rank = 0; rank < ranking.size(); ++rank) {
      Position candidate = before.positions[ranking[rank]];
      for (std::size_t brighter = rank; brighter-- > 0;) {
        candidate += attraction_step(candidate, before.positions[ranking[brighter]], settings_.attractiveness,
                                     settings_.absorption);
      }
      add_random_step(candidate, settings_.step, random);
      swarm.accept(ranking[rank], candidate, fitness_of);
    }
  }
}

void ImprovedFireflyOptimizer::move(Swarm& swarm, const Fitness& fitness_of, RandomSequence& random) const {
  for (int iteration = 0; iteration < settings_.iterations; ++iteration) {
    const Swarm before = swarm;
    const std::vector<std::size_t> ranking = before.ranking();
    const double brightest = before.fitness[ranking.front()];
    const auto brightness = [&](std::size_t member) {
      return 1.0 / (1.0 + std::sqrt(2.0 * (brightest - before.fitness[member])));
    };
    for (std::size_t rank = 0; rank < ranking.size(); ++rank) {
      const std::size_t member = ranking[rank], neighbor = ranking[rank > 0 ? rank - 1 : 0];
      Position candidate = before.positions[member];
      candidate +=
          attraction_step(candidate, before.positions[neighbor], settings_.attractiveness, settings_.absorption);
      add_random_step(candidate, std::exp(-settings_.noise_variance * brightness(member) / brightness(neighbor)),
                      random);
      swarm.accept(member, candidate, fitness_of);
    }
  }
}

}  // namespace patrol::slam
