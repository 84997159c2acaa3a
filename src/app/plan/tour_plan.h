#pragma once

#include <Eigen/Core>

#include <optional>
#include <string>
#include <vector>

#include "app/plan/plan_settings.h"
#include "core/grid.h"
#include "io/tour_stations.h"
#include "plan/routes/tour_order.h"

namespace patrol::app {

struct TourStop {
  io::TourStation station;
  Eigen::Vector2d p_m = Eigen::Vector2d::Zero();  ///< in the grid's frame
};

/// One stop of a tour that has its order. Times are from the tour's start.
struct TourVisit {
  std::size_t place = 0;  ///< 0 the start, 1 ... n the stops, n + 1 the end, if it is another place
  double leg_m = 0.0;     ///< of the way there
  double arrives_s = 0.0, waits_s = 0.0, leaves_s = 0.0, late_s = 0.0;
};

struct TourPlan {
  plan::TourOrder order;              ///< not found: no order leads to all that can be reached. Its indices are of what can be reached
  std::vector<TourVisit> visits;      ///< in order, from the start to the end, or back to it
  std::vector<std::size_t> unreachable;  ///< places to which there is no way from the start
  bool is_proved = true;                 ///< that; false: none was found, and the planner may have missed one
  std::vector<Eigen::Vector2d> points_m; ///< of the whole way, in the grid's frame
  int num_routes = 0;                 ///< planned
  double processor_s = 0.0;           ///< of them
};

/// The order in which to visit the stops from the start, ending at `p_end_m` or else back at the start, travel being by the settings' planner between
/// all pairs. Ways are planned one way and driven both: they cost the same. What cannot be reached is left out. None when interrupted.
std::optional<TourPlan> plan_tour(const Grid<plan::Cost>& costs, const Eigen::Vector2d& p_start_m, const std::vector<TourStop>& stops,
                                  const std::optional<Eigen::Vector2d>& p_end_m, const PlanSettings& settings);

}  // namespace patrol::app
