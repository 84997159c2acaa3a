#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <string_view>

#include "core/settings.h"
#include "plan/routes/ant_colony.h"
#include "plan/routes/dual_swarm_pso.h"
#include "plan/routes/q_learning.h"
#include "plan/routes/route_planner.h"

namespace patrol::plan {

/// Settings of all global planners; each planner uses its own section.
struct RoutePlannerSettings {
  int max_steps_millions = 0;         ///< maximum number of steps of an iterative planner, in millions; 0: none
  double cost_weight = 0.0;           ///< number of additional cells that a cell at the highest passable cost counts as
  AntColonySettings ant_colony = {};  ///< ant system, plain and improved
  ImprovedColonySettings improved_colony = {};  ///< improved colony only [Li22]
  DualSwarmPsoSettings dual_swarm_pso = {};
  QLearningSettings q_learning = {};

  template <typename Self, typename Visitor>
  static void fields(Self& self, Visitor& visit) {
    visit("max_steps_millions", self.max_steps_millions, between(0, 1000000));
    visit("cost_weight", self.cost_weight, between(0.0, 50.0));
    visit("ant_colony", self.ant_colony);
    visit("improved_colony", self.improved_colony);
    visit("dual_swarm_pso", self.dual_swarm_pso);
    visit("q_learning", self.q_learning);
  }
};

/// Row of the table of global planners.
struct RoutePlannerRow {
  std::string_view name;     ///< text in settings and on the command line
  std::string_view summary;  ///< one line of documentation
  std::unique_ptr<RoutePlanner> (*make)(const RoutePlannerSettings& settings, std::uint64_t seed);
  bool is_drivable = true;  ///< whether its paths keep off lethal cells and follow costs
};

/// Table of all global planners.
std::span<const RoutePlannerRow> route_planners();
/// Rows of the planners with `is_drivable`.
std::span<const RoutePlannerRow> drivable_route_planners();

/// Creates a planner by name. Throws InputError for an unknown name or an invalid setting. Also throws for the
/// any-angle optimum with a cost weight, which it does not support.
std::unique_ptr<RoutePlanner> make_route_planner(const std::string& name, const RoutePlannerSettings& settings,
                                                 std::uint64_t seed);

}  // namespace patrol::plan
