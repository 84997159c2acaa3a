#include "app/plan/route_metrics.h"

#include <cstdint>
#include <memory>

#include "app/common/process_cost.h"
#include "app/plan/plan_grid.h"
#include "plan/routes/grid_search.h"
#include "plan/routes/line_of_sight.h"
#include "plan/routes/smooth_route.h"
#include "plan/routes/visibility_graph.h"

namespace patrol::app {
namespace {

void smooth(const Grid<plan::Cost>& costs, const PlanSettings& settings, plan::Route& route) {
  const double cost_weight = settings.routes.cost_weight;
  route.points =
      plan::smooth_route(costs, cost_weight, settings.min_clearance_m / costs.geometry().resolution_m, route.points);
  route.clearance = plan::compute_clearance(costs, route.points);
  route.length = route.cost = 0.0;
  for (std::size_t i = 1; i < route.points.size(); ++i) {
    route.length += (route.points[i] - route.points[i - 1]).norm();
    route.cost += plan::line_cost(costs, plan::cost_factors(cost_weight), plan::cell_of(route.points[i - 1]),
                                  plan::cell_of(route.points[i]))
                      .value();
  }
}

bool is_too_large(const Grid<plan::Cost>& costs, std::int64_t max_passable) {
  return static_cast<std::int64_t>(costs.geometry().size()) > 8 * max_passable || num_passable(costs) > max_passable;
}

}  // namespace

int count_turns(const std::vector<Eigen::Vector2d>& points) {
  int num_turns = 0;
  for (std::size_t i = 2; i < points.size(); ++i) {
    const Eigen::Vector2d before = points[i - 1] - points[i - 2], after = points[i] - points[i - 1];  // exact
    if (before.x() * after.y() != before.y() * after.x() || before.dot(after) < 0.0) ++num_turns;
  }
  return num_turns;
}

plan::Route plan_route(plan::RoutePlanner& planner, const Grid<plan::Cost>& costs, Cell start, Cell goal,
                       const PlanSettings& settings) {
  plan::Route route = planner.plan(costs, start, goal);
  if (settings.smooth && route.status == plan::PlanStatus::kFound) smooth(costs, settings, route);
  return route;
}

RouteMetrics evaluate_route(const Grid<plan::Cost>& costs, Cell start, Cell goal, const PlanSettings& settings) {
  const std::unique_ptr<plan::RoutePlanner> planner =
      plan::make_route_planner(settings.planner, settings.routes, settings.seed);
  RouteMetrics metrics;
  const double processor_s = process_seconds(), wall_s = wall_seconds();
  metrics.route = plan_route(*planner, costs, start, goal, settings);
  metrics.processor_s = process_seconds() - processor_s;
  metrics.wall_s = wall_seconds() - wall_s;
  metrics.num_turns = count_turns(metrics.route.points);

  using plan::GridSearch;
  const plan::Route octile = GridSearch(GridSearch::Method::kAstar).plan(costs, start, goal);
  if (octile.status != plan::PlanStatus::kFound) return metrics;
  metrics.octile_length = octile.length;
  const double cost_weight = settings.routes.cost_weight;
  if (cost_weight > 0.0)
    metrics.octile_cost = GridSearch(GridSearch::Method::kAstar, cost_weight).plan(costs, start, goal).cost;
  if (settings.planner == "visibility_graph") metrics.any_angle_length = metrics.route.length;
  else if (is_too_large(costs, settings.max_any_angle_cells)) metrics.is_any_angle_skipped = true;
  else metrics.any_angle_length = plan::VisibilityGraphPlanner().plan(costs, start, goal).length;
  return metrics;
}

}  // namespace patrol::app
