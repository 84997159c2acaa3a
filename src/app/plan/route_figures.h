#pragma once

#include <optional>
#include <string>
#include <vector>

#include "app/plan/plan_settings.h"
#include "core/grid.h"
#include "plan/routes/route_planner.h"

namespace patrol::app {

/// A route beside what is the best on the same grid. Lengths and costs are in cells.
struct RouteFigures {
  plan::Route route;
  int num_turns = 0;                          ///< points at which it changes direction
  double processor_s = 0.0, wall_s = 0.0;     ///< of the planner alone
  std::optional<double> octile_length = {};   ///< the shortest over eight neighbours, by A*; none if there is no route
  std::optional<double> octile_cost = {};     ///< the cheapest over them; likewise, and none if costs weigh nothing
  std::optional<double> any_angle_length = {};
  bool is_any_angle_left_out = false;         ///< the grid is too large for it
};

/// By how much of the best a route exceeds it.
inline double gap(double value, double best) { return best > 0.0 ? value / best - 1.0 : 0.0; }

int count_turns(const std::vector<Eigen::Vector2d>& points);

/// Plans and, if the settings say so, smooths: then length, cost and clearance are the smooth route's, history and iterations the planner's.
plan::Route plan_route(plan::RoutePlanner& planner, const Grid<plan::Cost>& costs, Cell start, Cell goal, const PlanSettings& settings);

RouteFigures figures_of_route(const Grid<plan::Cost>& costs, Cell start, Cell goal, const PlanSettings& settings);

}  // namespace patrol::app
