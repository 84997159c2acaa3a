#pragma once

#include <cstdint>

#include "core/random.h"
#include "core/settings.h"
#include "plan/routes/route_planner.h"

namespace patrol::plan {

struct QLearningSettings {
  int episodes = 5000;              ///< number of episodes
  double learning_rate = 1.0;       ///< learning rate, alpha
  double discount = 1.0;            ///< discount factor of future rewards, gamma
  double exploration = 0.1;         ///< epsilon, probability of a random step; falls from this value to 0
  double max_steps_per_cell = 4.0;  ///< steps after which an episode ends, as a multiple of the number of cells

  template <typename Self, typename Visitor>
  static void fields(Self& self, Visitor& visit) {
    visit("episodes", self.episodes, between(1, 1e6));
    visit("learning_rate", self.learning_rate, between(0.01, 1.0));
    visit("discount", self.discount, between(0.5, 1.0));
    visit("exploration", self.exploration, between(0.0, 1.0));
    visit("max_steps_per_cell", self.max_steps_per_cell, between(0.1, 1000.0));
  }
};

/// Tabular Q-learning [Watkins89] on the grid, epsilon-greedy. This is the method class of the orchard robot's planner
/// [Mao20] that [Li22] compares with; its details are not known. The reward of a step is its negative cost, so that a
/// table of zeros is optimistic and favors untried steps. An iteration is an episode from the start; its route, if any,
/// follows the best steps of the table. Not complete, because episodes end.
class QLearning : public RoutePlanner {
 public:
  QLearning(const QLearningSettings& settings, double cost_weight, std::uint64_t seed);

  bool is_complete() const override { return false; }

 private:
  void search(const Grid<Cost>& costs, Cell start, Cell goal, Route& route) override;

  QLearningSettings settings_;
  RandomStream stream_;
};

}  // namespace patrol::plan
