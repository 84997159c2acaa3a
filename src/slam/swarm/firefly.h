#pragma once

#include "slam/swarm/swarm.h"

namespace patrol::slam {

struct FireflySettings {
  int iterations = 5;
  double attractiveness = 1.0;  ///< beta_0
  double absorption = 0.01;     ///< gamma, per square of the positions' unit: 0.01 for whitened increments
  double step = 0.5;            ///< alpha, in the positions' unit
};

/// Firefly algorithm (Yang, "Firefly algorithms for multimodal optimization", SAGA 2009): a firefly flies towards every brighter one in
/// turn, the less the farther it is, and a random step. Its light is judged once an iteration, not once a flight: with N fireflies that
/// are N judgements rather than N^2 / 2.
class FireflyOptimizer : public SwarmOptimizer {
 public:
  explicit FireflyOptimizer(const FireflySettings& settings) : settings_(settings) {}

  void move(Swarm& swarm, const Fitness& judge, RandomSequence& random) const override;

 private:
  FireflySettings settings_;
};

struct ImprovedFireflySettings {
  int iterations = 5;
  double attractiveness = 1.0;
  double absorption = 0.01;
  double noise_variance = 1.0;  ///< R of eq. 3: how fast the random step shrinks as a firefly outshines its neighbour
};

/// Improved firefly algorithm (Cui et al., Control and Decision 2021, paper 001): a firefly flies towards its one neighbour in the order
/// of brightness, with a random step alpha = exp(-R I_i / I_j) (eqs. 3, 4).
///
/// Resolved readings. Eq. 2 prints the brightness I as a *distance* between predicted and newest observation and state, yet eq. 3
/// wants the step to grow when I_i < I_j, "to look farther": I must grow as the distance falls. With d^2 = 2 (f_max - f), the squared
/// Mahalanobis distance that the best member does not have, I = 1 / (1 + d). "The newest state value" of eq. 2 can only be the predicted
/// one: taken as the true one, which gives the paper's figures, it would be known to nobody.
class ImprovedFireflyOptimizer : public SwarmOptimizer {
 public:
  explicit ImprovedFireflyOptimizer(const ImprovedFireflySettings& settings) : settings_(settings) {}

  void move(Swarm& swarm, const Fitness& judge, RandomSequence& random) const override;

 private:
  ImprovedFireflySettings settings_;
};

}  // namespace patrol::slam
