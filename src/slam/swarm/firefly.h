#pragma once

#include "slam/swarm/swarm.h"

namespace patrol::slam {

struct FireflySettings {
  int iterations = 5;
  double attractiveness = 1.0;  ///< beta_0
  double absorption = 0.01;     ///< gamma, per square of the unit of the positions: 0.01 for whitened increments
  double step = 0.5;            ///< alpha, in the unit of the positions
};

/// Firefly algorithm [Yang09]: a firefly moves toward every brighter one in sequence, less with distance, plus a random
/// step.
/// Deviation from [Yang09]: the fitness is evaluated once per iteration, not once per move, which reduces the
/// evaluations from N^2 / 2 to N.
class FireflyOptimizer : public SwarmOptimizer {
 public:
  explicit FireflyOptimizer(const FireflySettings& settings) : settings_(settings) {}

  void move(Swarm& swarm, const Fitness& fitness_of, RandomSequence& random) const override;

 private:
  FireflySettings settings_;
};

struct ImprovedFireflySettings {
  int iterations = 5;
  double attractiveness = 1.0;
  double absorption = 0.01;
  /// R of eq. 3: decay rate of the random step with the brightness relative to the neighbor
  double noise_variance = 1.0;
};

/// Improved firefly algorithm [Cui21]: a firefly moves toward its brighter neighbor in brightness order, with a random
/// step alpha = exp(-R I_i / I_j) (eqs. 3, 4).
///
/// Interpretation of [Cui21]: eq. 2 defines the brightness I as a distance between predicted and newest observation and
/// state. Eq. 3 requires the step to grow if I_i < I_j, so I must increase as the distance decreases. Here I = 1 / (1 +
/// d), with d^2 = 2 (f_max - f), the squared Mahalanobis distance relative to the best member. "The newest state value"
/// in eq. 2 is read as the predicted state. The published values follow with the true state, which no filter has.
class ImprovedFireflyOptimizer : public SwarmOptimizer {
 public:
  explicit ImprovedFireflyOptimizer(const ImprovedFireflySettings& settings) : settings_(settings) {}

  void move(Swarm& swarm, const Fitness& fitness_of, RandomSequence& random) const override;

 private:
  ImprovedFireflySettings settings_;
};

}  // namespace patrol::slam
