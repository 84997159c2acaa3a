#include "slam/swarm/swarm.h"

#include <algorithm>
#include <numeric>
#include <utility>

namespace patrol::slam {

std::size_t Swarm::best() const {
  return static_cast<std::size_t>(std::max_element(fitness.begin(), fitness.end()) - fitness.begin());
}

std::vector<std::size_t> Swarm::ranking() const {
  std::vector<std::size_t> order(size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) { return fitness[a] > fitness[b]; });
  return order;
}

bool Swarm::accept(std::size_t member, const Position& candidate, const Fitness& fitness_of) {
  const double candidate_fitness = fitness_of(member, candidate);
  if (!(candidate_fitness > fitness[member])) return false;
  positions[member] = candidate;
  fitness[member] = candidate_fitness;
  return true;
}

Swarm make_swarm(std::vector<Position> positions, const Fitness& fitness_of) {
  Swarm swarm{.positions = std::move(positions), .fitness = {}};
  for (std::size_t i = 0; i < swarm.size(); ++i) swarm.fitness.push_back(fitness_of(i, swarm.positions[i]));
  return swarm;
}

}  // namespace patrol::slam
