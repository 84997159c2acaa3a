#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "core/settings.h"
#include "plan/routes/ant_colony.h"
#include "plan/routes/q_learning.h"
#include "plan/routes/route_planner.h"
#include "plan/routes/two_swarms.h"

namespace patrol::plan {

/// Every planner of the family by name, with what it needs.
struct RoutePlannerSettings {
  std::string planner = "theta_star";
  double cost_weight = 0.0;              ///< a cell at the highest passable cost counts as 1 + this many cells
  AntColonySettings ant_colony = {};     ///< of both colonies
  DiffusionSettings diffusion = {};      ///< of paper 003's
  TwoSwarmsSettings two_swarms = {};
  QLearningSettings q_learning = {};

  template <typename Self, typename Visitor>
  static void fields(Self& self, Visitor& visit) {
    visit("planner", self.planner,
          one_of({"astar", "dijkstra", "theta_star", "any_angle_optimum", "plain_ant_colony", "ant_colony", "two_swarms", "q_learning"}));
    visit("cost_weight", self.cost_weight, between(0.0, 50.0));
    visit("ant_colony", self.ant_colony);
    visit("diffusion", self.diffusion);
    visit("two_swarms", self.two_swarms);
    visit("q_learning", self.q_learning);
  }
};

/// In the order of the settings' list.
std::vector<std::string> route_planner_names();

/// The planner that the settings name. Throws InputError for a wrong setting, and for the any-angle optimum with a cost weight: it knows none.
std::unique_ptr<RoutePlanner> make_route_planner(const RoutePlannerSettings& settings, std::uint64_t seed);

}  // namespace patrol::plan
