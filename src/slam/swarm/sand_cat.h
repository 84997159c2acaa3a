#pragma once

#include "slam/swarm/swarm.h"

namespace patrol::slam {

/// Sand cat swarm optimization [Seyyedabbasi23]: cats explore around the best one while |R| > 1 and attack it at a
/// random angle otherwise. The sensitivity range decreases from 2 to 0.
///
/// Improved variant [Wu25]: after each generation the best cat tries a Cauchy mutation (eq. 1). The S best positions of
/// the previous generation replace the S worst where that increases the fitness of the replaced member. S = ceil((N -
/// 1) sin(pi t / 2 T)) (eq. 2).
class SandCatOptimizer : public SwarmOptimizer {
 public:
  SandCatOptimizer(int iterations, bool is_improved) : iterations_(iterations), is_improved_(is_improved) {}

  void move(Swarm& swarm, const Fitness& fitness_of, RandomSequence& random) const override;

 private:
  void search_and_attack(int iteration, Swarm& swarm, const Fitness& fitness_of, RandomSequence& random) const;
  void replace_worst(int iteration, const Swarm& before, Swarm& swarm, const Fitness& fitness_of) const;

  int iterations_;
  bool is_improved_;
};

}  // namespace patrol::slam
