#pragma once

#include <cstdint>

#include "core/random.h"
#include "core/settings.h"
#include "plan/routes/route_planner.h"

namespace patrol::plan {

struct QLearningSettings {
  int episodes = 5000;
  double learning_rate = 1.0;     ///< alpha
  double discount = 1.0;          ///< gamma
  double exploration = 0.1;       ///< epsilon, the share of steps taken by chance, in the first episode; falls to 0 in the last
  double max_steps_share = 4.0;   ///< of an episode, as a share of the grid's cells; it ends there if not at the goal

  template <typename Self, typename Visitor>
  static void fields(Self& self, Visitor& visit) {
    visit("episodes", self.episodes, between(1, 1e6));
    visit("learning_rate", self.learning_rate, between(0.01, 1.0));
    visit("discount", self.discount, between(0.5, 1.0));
    visit("exploration", self.exploration, between(0.0, 1.0));
    visit("max_steps_share", self.max_steps_share, between(0.1, 1000.0));
  }
};

/// Q-learning (Watkins 1989) on the grid, one table, epsilon-greedy; the class of the orchard robot's planner that paper 003 compares with (Mao et al. 2020),
/// of which we know that much. A step's reward is minus its price, so that a table of zeros is hopeful and what was not tried is tried. An iteration is an
/// episode from the start; its route, if there is one, is what the table's best steps then lead along. Not complete: episodes end.
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
