#include "slam/swarm/bat.h"

#include <cmath>

namespace patrol::slam {

void BatOptimizer::move(Swarm& swarm, const Fitness& fitness_of, RandomSequence& random) const {
  const Eigen::Index coordinates = swarm.positions.front().size();
  std::vector<Position> velocities(swarm.size(), Position::Zero(coordinates));
  std::vector<double> loudness(swarm.size(), settings_.loudness);
  for (int iteration = 0; iteration < settings_.iterations; ++iteration) {
    const Position best = swarm.positions[swarm.best()];
    const double pulse_rate = settings_.pulse_rate * (1.0 - std::exp(-settings_.pulse_growth * iteration));
    for (std::size_t i = 0; i < swarm.size(); ++i) {
      velocities[i] += (best - swarm.positions[i]) * settings_.max_frequency * random.uniform();
      Position candidate = swarm.positions[i] + velocities[i];
      if (random.uniform() < pulse_rate) {
        candidate = best;
        for (double& coordinate : candidate) coordinate += settings_.local_step * loudness[i] * random.normal();
      }
      if (random.uniform() < loudness[i] && swarm.accept(i, candidate, fitness_of))
        loudness[i] *= settings_.loudness_decay;
    }
  }
}

}  // namespace patrol::slam
