#pragma once

#include "slam/swarm/swarm.h"

namespace patrol::slam {

struct BatSettings {
  int iterations = 5;
  double max_frequency = 1.0;   ///< maximum attraction to the best bat
  double loudness = 0.9;        ///< initial probability of accepting an improvement
  double loudness_decay = 0.9;  ///< factor per accepted improvement
  double pulse_rate = 0.5;      ///< final probability of a local search around the best bat
  double pulse_growth = 0.9;
  double local_step = 0.1;  ///< step of the local search, in the unit of the positions
};

/// Bat algorithm [Yang10, eqs. 2-6]: bats move with velocities relative to the best one, or search around it.
/// Improvements are accepted with a probability that decreases with every acceptance.
/// Deviation from [Yang10]: the pulse rate is the probability of the local search, not of skipping it.
class BatOptimizer : public SwarmOptimizer {
 public:
  explicit BatOptimizer(const BatSettings& settings) : settings_(settings) {}

  void move(Swarm& swarm, const Fitness& fitness_of, RandomSequence& random) const override;

 private:
  BatSettings settings_;
};

}  // namespace patrol::slam
