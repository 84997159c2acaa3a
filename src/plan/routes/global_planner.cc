#include "plan/routes/global_planner.h"

#include <cmath>
#include <utility>

#include "core/error.h"
#include "plan/routes/smooth_route.h"

namespace patrol::plan {

std::optional<Cell> nearest_passable(const Grid<Cost>& costs, const Eigen::Vector2d& p, double radius_m) {
  const GridGeometry& grid = costs.geometry();
  const Cell center = grid.cell_at(p);
  if (costs.contains(center) && costs.at(center) != kLethalCost) return center;
  const int radius_cells = static_cast<int>(std::ceil(radius_m / grid.resolution_m));
  std::optional<Cell> nearest;
  double nearest_m = radius_m;
  for (int row = center.row - radius_cells; row <= center.row + radius_cells; ++row) {
    for (int col = center.col - radius_cells; col <= center.col + radius_cells; ++col) {
      const Cell cell{col, row};
      if (!costs.contains(cell) || costs.at(cell) == kLethalCost) continue;
      const double distance_m = (grid.center_of(cell) - p).norm();
      if (distance_m > nearest_m || (nearest && distance_m == nearest_m)) continue;
      nearest = cell;
      nearest_m = distance_m;
    }
  }
  return nearest;
}

GlobalPlanner::GlobalPlanner(GlobalPlannerSettings settings, std::uint64_t seed) : settings_(std::move(settings)) {
  if (settings_.method == "visibility_graph") {
    throw InputError("global_planner.method = visibility_graph: not drivable: its paths touch lethal cells");
  }
  validate(settings_, "global_planner");
  planner_ = make_route_planner(settings_.method, settings_.family, seed);
}

PlanResult GlobalPlanner::plan(const Grid<Cost>& costs, const Eigen::Vector2d& p_map_start,
                               const Eigen::Vector2d& p_map_goal) {
  const GridGeometry& grid = costs.geometry();
  PlanResult result;
  const std::optional<Cell> start = nearest_passable(costs, p_map_start, settings_.start_tolerance_m);
  if (!start) {
    result.status = PlanStatus::kStartBlocked;
    return result;
  }
  const std::optional<Cell> goal = nearest_passable(costs, p_map_goal, settings_.goal_tolerance_m);
  if (!goal) {
    result.status = PlanStatus::kGoalBlocked;
    return result;
  }
  result.is_goal_moved = *goal != grid.cell_at(p_map_goal);
  const Route route = planner_->plan(costs, *start, *goal);
  result.status = route.status;
  result.num_expanded = route.num_expanded;
  if (route.status != PlanStatus::kFound) return result;

  result.cost_m = grid.resolution_m * route.cost;
  result.points_m = to_meters(grid, smooth_route(costs, settings_.family.cost_weight,
                                                 settings_.min_clearance_m / grid.resolution_m, route.points));
  result.points_m.insert(result.points_m.begin(), p_map_start);
  if (!result.is_goal_moved) result.points_m.push_back(p_map_goal);
  for (std::size_t i = 1; i < result.points_m.size(); ++i)
    result.length_m += (result.points_m[i] - result.points_m[i - 1]).norm();
  return result;
}

}  // namespace patrol::plan
