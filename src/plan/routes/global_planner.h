#pragma once

#include <Eigen/Core>

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "core/grid.h"
#include "core/settings.h"
#include "plan/perception/costmap.h"
#include "plan/routes/planners.h"

namespace patrol::plan {

struct GlobalPlannerSettings {
  RoutePlannerSettings family = {.max_steps_millions = 100, .cost_weight = 4.0};
  double goal_tolerance_m = 0.3;   ///< a blocked goal may be replaced by a free place this near
  double start_tolerance_m = 0.6;  ///< likewise the start: the robot stands there, so it must get out
  double kept_clearance_m = 0.3;   ///< as far as this, smoothing brings a route no nearer to what is lethal

  template <typename Self, typename Visitor>
  static void fields(Self& self, Visitor& visit) {
    RoutePlannerSettings::fields(self.family, visit);
    visit("goal_tolerance_m", self.goal_tolerance_m, between(0.0, 5.0));
    visit("start_tolerance_m", self.start_tolerance_m, between(0.0, 5.0));
    visit("kept_clearance_m", self.kept_clearance_m, between(0.0, 5.0));
  }
};

struct PlanResult {
  PlanStatus status = PlanStatus::kNoRoute;
  std::vector<Eigen::Vector2d> points_m;  ///< in map, from start to goal
  double length_m = 0.0;                  ///< of the points
  double cost_m = 0.0;                    ///< from cell to cell: length, each metre weighted by its cells' costs
  bool is_goal_moved = false;             ///< the goal was blocked; the route ends at the nearest free place
  std::int64_t num_expanded = 0;
};

/// From a place to a place on the costmap, by any planner of the family (routes/planners.h), smoothed. Routes leave and reach the exact places by
/// the centres of their cells.
class GlobalPlanner {
 public:
  /// Throws InputError like make_route_planner, and for the any-angle optimum: it touches what is lethal.
  GlobalPlanner(const std::string& planner, const GlobalPlannerSettings& settings, std::uint64_t seed);

  PlanResult plan(const Grid<Cost>& costs, const Eigen::Vector2d& p_map_start, const Eigen::Vector2d& p_map_goal);

 private:
  GlobalPlannerSettings settings_;
  std::unique_ptr<RoutePlanner> planner_;
};

/// The cell nearest to `p` that is not lethal, within `radius_m`; none if all are lethal. A point in a passable cell
/// is its own nearest.
std::optional<Cell> nearest_passable(const Grid<Cost>& costs, const Eigen::Vector2d& p, double radius_m);

}  // namespace patrol::plan
