#include "plan/routes/planners.h"

#include <optional>

#include "core/error.h"
#include "plan/routes/any_angle_optimum.h"
#include "plan/routes/grid_search.h"
#include "plan/routes/theta_star.h"

namespace patrol::plan {
namespace {

/// Picks out what the field `planner` may be.
struct NamesVisitor {
  std::vector<std::string> names;

  template <typename Value>
  void operator()(const char* name, const Value&, const Limits& limits = {}) {
    if (std::string(name) == "planner") names = limits.allowed;
  }
};

}  // namespace

std::vector<std::string> route_planner_names() {
  NamesVisitor visitor;
  const RoutePlannerSettings settings;
  RoutePlannerSettings::fields(settings, visitor);
  return visitor.names;
}

std::unique_ptr<RoutePlanner> make_route_planner(const RoutePlannerSettings& settings, std::uint64_t seed) {
  validate(settings, "routes");
  const std::string& name = settings.planner;
  const double cost_weight = settings.cost_weight;
  if (name == "astar") return std::make_unique<GridSearch>(GridSearch::Method::kAstar, cost_weight);
  if (name == "dijkstra") return std::make_unique<GridSearch>(GridSearch::Method::kDijkstra, cost_weight);
  if (name == "theta_star") return std::make_unique<ThetaStar>(cost_weight);
  if (name == "plain_ant_colony") return std::make_unique<AntColony>(settings.ant_colony, std::nullopt, cost_weight, seed);
  if (name == "ant_colony") return std::make_unique<AntColony>(settings.ant_colony, settings.diffusion, cost_weight, seed);
  if (name == "two_swarms") return std::make_unique<TwoSwarms>(settings.two_swarms, cost_weight, seed);
  if (name == "q_learning") return std::make_unique<QLearning>(settings.q_learning, cost_weight, seed);
  if (cost_weight != 0.0) throw InputError("routes.cost_weight: the any-angle optimum knows no costs; it must be 0");
  return std::make_unique<AnyAngleOptimum>();
}

}  // namespace patrol::plan
