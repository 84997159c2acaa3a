#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <Eigen/Core>

#include "core/grid.h"
#include "core/settings.h"
#include "plan/perception/costmap.h"
#include "plan/routes/maneuver.h"
#include "plan/routes/planners.h"

namespace patrol::plan {

struct GlobalPlannerSettings {
  std::string method = "theta_star";  ///< method of the global planner, see `patrol list`
  RoutePlannerSettings family = {.max_steps_millions = 100, .cost_weight = 4.0};
  double goal_tolerance_m = 0.3;   ///< search radius for a free cell if the goal is blocked
  double start_tolerance_m = 0.6;  ///< search radius for a free cell if the start is blocked
  double min_clearance_m = 0.3;    ///< clearance that smoothing keeps, or the route's if it is smaller

  template <typename Self, typename Visitor>
  static void fields(Self& self, Visitor& visit) {
    visit("method", self.method, one_of(drivable_route_planners()));
    RoutePlannerSettings::fields(self.family, visit);
    visit("goal_tolerance_m", self.goal_tolerance_m, between(0.0, 5.0));
    visit("start_tolerance_m", self.start_tolerance_m, between(0.0, 5.0));
    visit("min_clearance_m", self.min_clearance_m, between(0.0, 5.0));
  }
};

struct PlanResult {
  PlanStatus status = PlanStatus::kNoRoute;
  std::vector<Eigen::Vector2d> points_m = {};  ///< path in map, from start to goal
  Maneuver maneuver = {};                      ///< the path with headings, for a robot that cannot turn in place
  double length_m = 0.0;                       ///< length of the path
  double cost_m = 0.0;                         ///< length from cell to cell, each meter weighted by its cells' costs
  bool is_goal_moved = false;                  ///< the goal was blocked; the path ends at the nearest free position
  std::int64_t num_expanded = 0;
};

/// Plans a path between two positions on the costmap by one of the planners (plan/routes/planners.h), and smooths it.
/// The path connects the exact positions through the centers of their cells.
class GlobalPlanner {
 public:
  /// Throws InputError like make_route_planner, and for `visibility_graph`, whose paths touch lethal cells.
  GlobalPlanner(GlobalPlannerSettings settings, std::uint64_t seed);

  PlanResult plan(const Grid<Cost>& costs, const Eigen::Vector2d& p_map_start, const Eigen::Vector2d& p_map_goal);

 private:
  GlobalPlannerSettings settings_;
  std::unique_ptr<RoutePlanner> planner_;
};

/// Cell nearest to `p` within `radius_m` that is not lethal; none if all are lethal. For a point in a passable cell it
/// is that cell.
std::optional<Cell> nearest_passable(const Grid<Cost>& costs, const Eigen::Vector2d& p, double radius_m);

}  // namespace patrol::plan
