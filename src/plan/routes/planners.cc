#include "plan/routes/planners.h"

#include <algorithm>
#include <array>
#include <optional>

#include <fmt/format.h>

#include "core/error.h"
#include "core/named_table.h"
#include "plan/routes/grid_search.h"
#include "plan/routes/theta_star.h"
#include "plan/routes/visibility_graph.h"

namespace patrol::plan {
namespace {

using Settings = RoutePlannerSettings;
using Planner = std::unique_ptr<RoutePlanner>;

Planner make_visibility_graph(const Settings& settings, std::uint64_t) {
  if (settings.cost_weight != 0.0)
    throw InputError(fmt::format("routes.cost_weight = {}: must be 0 for visibility_graph", settings.cost_weight));
  return std::make_unique<VisibilityGraphPlanner>();
}

/// Drivable planners come first.
constexpr std::array kPlanners = std::to_array<RoutePlannerRow>({
    {"astar", "A* on the grid, eight neighbors",
     [](const Settings& s, std::uint64_t) -> Planner {
       return std::make_unique<GridSearch>(GridSearch::Method::kAstar, s.cost_weight);
     }},
    {"dijkstra", "Dijkstra's algorithm on the grid, eight neighbors",
     [](const Settings& s, std::uint64_t) -> Planner {
       return std::make_unique<GridSearch>(GridSearch::Method::kDijkstra, s.cost_weight);
     }},
    {"theta_star", "Theta*: any-angle search with lines of sight",
     [](const Settings& s, std::uint64_t) -> Planner { return std::make_unique<ThetaStar>(s.cost_weight); }},
    {"ant_system", "Ant system without the improvements of [Li22]",
     [](const Settings& s, std::uint64_t seed) -> Planner {
       return std::make_unique<AntColony>(s.ant_colony, std::nullopt, s.cost_weight, seed);
     }},
    {"ant_colony_li22", "Improved ant colony of [Li22]",
     [](const Settings& s, std::uint64_t seed) -> Planner {
       return std::make_unique<AntColony>(s.ant_colony, s.improved_colony, s.cost_weight, seed);
     }},
    {"dual_swarm_pso", "Particle swarm optimization with two swarms",
     [](const Settings& s, std::uint64_t seed) -> Planner {
       return std::make_unique<DualSwarmPso>(s.dual_swarm_pso, s.cost_weight, seed);
     }},
    {"q_learning", "Q-learning with a potential field as its initial value",
     [](const Settings& s, std::uint64_t seed) -> Planner {
       return std::make_unique<QLearning>(s.q_learning, s.cost_weight, seed);
     }},
    {"visibility_graph", "Shortest any-angle path by a visibility graph; touches obstacles, no costs",
     make_visibility_graph, false},
});

}  // namespace

std::span<const RoutePlannerRow> route_planners() { return kPlanners; }

std::span<const RoutePlannerRow> drivable_route_planners() {
  const auto* const end =
      std::find_if(kPlanners.begin(), kPlanners.end(), [](const RoutePlannerRow& row) { return !row.is_drivable; });
  return {kPlanners.begin(), end};
}

std::unique_ptr<RoutePlanner> make_route_planner(const std::string& name, const RoutePlannerSettings& settings,
                                                 std::uint64_t seed) {
  validate(settings, "routes");
  std::unique_ptr<RoutePlanner> planner = row_named(route_planners(), name, "planner").make(settings, seed);
  if (settings.max_steps_millions > 0) planner->limit_steps(1'000'000LL * settings.max_steps_millions);
  return planner;
}

}  // namespace patrol::plan
