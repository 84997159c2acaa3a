#include "plan/routes/planners.h"

#include <optional>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "core/error.h"
#include "plan/routes/any_angle_optimum.h"
#include "plan/routes/grid_search.h"
#include "plan/routes/theta_star.h"

namespace patrol::plan {
namespace {

std::unique_ptr<RoutePlanner> make(const std::string& name, const RoutePlannerSettings& settings, std::uint64_t seed) {
  const double cost_weight = settings.cost_weight;
  if (name == "astar") return std::make_unique<GridSearch>(GridSearch::Method::kAstar, cost_weight);
  if (name == "dijkstra") return std::make_unique<GridSearch>(GridSearch::Method::kDijkstra, cost_weight);
  if (name == "theta_star") return std::make_unique<ThetaStar>(cost_weight);
  if (name == "any_angle_optimum") {
    if (cost_weight != 0.0) throw InputError("routes.cost_weight: the any-angle optimum knows no costs; it must be 0");
    return std::make_unique<AnyAngleOptimum>();
  }
  if (name == "plain_ant_colony") return std::make_unique<AntColony>(settings.ant_colony, std::nullopt, cost_weight, seed);
  if (name == "ant_colony") return std::make_unique<AntColony>(settings.ant_colony, settings.improved_colony, cost_weight, seed);
  if (name == "two_swarms") return std::make_unique<TwoSwarms>(settings.two_swarms, cost_weight, seed);
  if (name == "q_learning") return std::make_unique<QLearning>(settings.q_learning, cost_weight, seed);
  throw InputError(fmt::format("there is no planner '{}' (known: {})", name, fmt::join(route_planner_names(), ", ")));
}

}  // namespace

std::vector<std::string> route_planner_names() {
  return {"astar", "dijkstra", "theta_star", "any_angle_optimum", "plain_ant_colony", "ant_colony", "two_swarms", "q_learning"};
}

std::unique_ptr<RoutePlanner> make_route_planner(const std::string& name, const RoutePlannerSettings& settings, std::uint64_t seed) {
  validate(settings, "routes");
  std::unique_ptr<RoutePlanner> planner = make(name, settings, seed);
  if (settings.max_steps_millions > 0) planner->limit_steps(1'000'000LL * settings.max_steps_millions);
  return planner;
}

}  // namespace patrol::plan
