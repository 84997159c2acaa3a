#pragma once

#include "slam/swarm/swarm.h"

namespace patrol::slam {

/// Whale optimization algorithm [Mirjalili16]. Each whale encircles the best one (eqs. 2.1-2.4), moves on a spiral
/// around it (eq. 2.5) or follows a random one (eqs. 2.7, 2.8).
class WhaleOptimizer : public SwarmOptimizer {
 public:
  explicit WhaleOptimizer(int iterations) : iterations_(iterations) {}

  void move(Swarm& swarm, const Fitness& fitness_of, RandomSequence& random) const override;

 private:
  int iterations_;
};

}  // namespace patrol::slam
