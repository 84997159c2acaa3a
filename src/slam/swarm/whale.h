#pragma once

#include "slam/swarm/swarm.h"

namespace patrol::slam {

/// Whale optimisation (Mirjalili, Lewis, "The whale optimization algorithm", Advances in Engineering Software 2016): each whale encircles
/// the best one (eq. 2.1-2.4), swims a spiral round it (eq. 2.5) or follows another (eq. 2.7-2.8).
class WhaleOptimizer : public SwarmOptimizer {
 public:
  explicit WhaleOptimizer(int iterations) : iterations_(iterations) {}

  void move(Swarm& swarm, const Fitness& judge, RandomSequence& random) const override;

 private:
  int iterations_;
};

}  // namespace patrol::slam
