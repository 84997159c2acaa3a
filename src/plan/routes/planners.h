#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <string_view>

#include "core/settings.h"
#include "plan/routes/ant_colony.h"
#include "plan/routes/q_learning.h"
#include "plan/routes/route_planner.h"
#include "plan/routes/two_swarms.h"

namespace patrol::plan {

/// What the planners of the family need; each takes what is its own.
struct RoutePlannerSettings {
  int max_steps_millions = 0;            ///< from cell to cell, of ants, particles and episodes; then the best so far is taken. 0: as many as it needs
  double cost_weight = 0.0;              ///< a cell at the highest passable cost counts as 1 + this many cells
  AntColonySettings ant_colony = {};     ///< of both colonies
  ImprovedColonySettings improved_colony = {};  ///< of the improved one: paper 003's
  TwoSwarmsSettings two_swarms = {};
  QLearningSettings q_learning = {};

  template <typename Self, typename Visitor>
  static void fields(Self& self, Visitor& visit) {
    visit("max_steps_millions", self.max_steps_millions, between(0, 1000000));
    visit("cost_weight", self.cost_weight, between(0.0, 50.0));
    visit("ant_colony", self.ant_colony);
    visit("improved_colony", self.improved_colony);
    visit("two_swarms", self.two_swarms);
    visit("q_learning", self.q_learning);
  }
};

/// Row of the table of global planners.
struct RoutePlannerRow {
  std::string_view name;     ///< text in settings and on the command line
  std::string_view summary;  ///< one line of documentation
  std::unique_ptr<RoutePlanner> (*make)(const RoutePlannerSettings& settings, std::uint64_t seed);
  bool is_drivable = true;  ///< whether its paths keep off lethal cells and follow costs, so that a robot can drive along them
};

/// Every global planner.
std::span<const RoutePlannerRow> route_planners();
/// The global planners that a robot can drive by.
std::span<const RoutePlannerRow> drivable_route_planners();

/// Builds the planner of that name. Throws InputError for an unknown name or a wrong setting, and for the any-angle optimum with a cost weight: it
/// supports none.
std::unique_ptr<RoutePlanner> make_route_planner(const std::string& name, const RoutePlannerSettings& settings, std::uint64_t seed);

}  // namespace patrol::plan
