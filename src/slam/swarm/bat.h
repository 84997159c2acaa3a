#pragma once

#include "slam/swarm/swarm.h"

namespace patrol::slam {

struct BatSettings {
  int iterations = 5;
  double max_frequency = 1.0;     ///< pull towards the best bat, at most
  double loudness = 0.9;          ///< chance to take a better place, at first
  double loudness_decay = 0.9;    ///< each time that it does
  double pulse_rate = 0.5;        ///< chance to fly by velocity rather than to look around the best bat, in the end
  double pulse_growth = 0.9;
  double local_step = 0.1;        ///< of looking around, in the positions' unit
};

/// Bat algorithm (Yang, "A new metaheuristic bat-inspired algorithm", NICSO 2010, eqs. 2-6): bats fly with velocities towards the best
/// one, or look around it. A place is taken with a chance that falls each time.
class BatOptimizer : public SwarmOptimizer {
 public:
  explicit BatOptimizer(const BatSettings& settings) : settings_(settings) {}

  void move(Swarm& swarm, const Fitness& judge, RandomSequence& random) const override;

 private:
  BatSettings settings_;
};

}  // namespace patrol::slam
