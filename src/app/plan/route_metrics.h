#pragma once

#include <optional>
#include <string>
#include <vector>

#include "app/plan/plan_settings.h"
#include "core/grid.h"
#include "plan/routes/route_planner.h"

namespace patrol::app {

/// Metrics of a route compared with optimal routes on its grid. Lengths and costs are in cells.
struct RouteMetrics {
  plan::Route route;
  int num_turns = 0;                         ///< points at which the direction changes
  double processor_s = 0.0, wall_s = 0.0;    ///< CPU and wall time of the planner alone
  std::optional<double> octile_length = {};  ///< minimum over eight neighbors, by A*; none without a route
  std::optional<double> octile_cost = {};    ///< minimum cost over eight neighbors; none without cost weight
  std::optional<double> any_angle_length = {};
  bool is_any_angle_skipped = false;  ///< the grid is too large for it
};

/// Relative excess of a value over the optimum.
inline double gap(double value, double best) { return best > 0.0 ? value / best - 1.0 : 0.0; }

int count_turns(const std::vector<Eigen::Vector2d>& points);

/// Plans and, if set, smooths. Length, cost and clearance are then those of the smooth route, history and iterations
/// those of the planner.
plan::Route plan_route(plan::RoutePlanner& planner, const Grid<plan::Cost>& costs, Cell start, Cell goal,
                       const PlanSettings& settings);

RouteMetrics evaluate_route(const Grid<plan::Cost>& costs, Cell start, Cell goal, const PlanSettings& settings);

}  // namespace patrol::app
