#pragma once

#include "slam/swarm/swarm.h"

namespace patrol::slam {

/// Sand cat swarm optimisation (Seyyedabbasi, Kiani, "Sand cat swarm optimization", Engineering with Computers 2023): cats search around
/// the best one while their hearing reaches far, and pounce on it at a random angle when it does not. Reach falls from 2 to 0.
///
/// Improved (Wu et al., Journal of Electronic Measurement and Instrumentation 2025, paper 000): after each generation the best cat tries
/// a Cauchy mutation (eq. 1), and the S best of the generation before stand in for the S worst, S = ceil((N - 1) sin(pi t / 2 T)) (eq. 2),
/// which each judges on its own map.
class SandCatOptimizer : public SwarmOptimizer {
 public:
  SandCatOptimizer(int iterations, bool is_improved) : iterations_(iterations), is_improved_(is_improved) {}

  void move(Swarm& swarm, const Fitness& judge, RandomSequence& random) const override;

 private:
  void hunt(int iteration, Swarm& swarm, const Fitness& judge, RandomSequence& random) const;
  void inherit(int iteration, const Swarm& before, Swarm& swarm, const Fitness& judge) const;

  int iterations_;
  bool is_improved_;
};

}  // namespace patrol::slam
