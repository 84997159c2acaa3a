#pragma once

#include <optional>
#include <string>
#include <vector>

#include <Eigen/Core>

#include "app/plan/plan_settings.h"
#include "core/grid.h"
#include "io/files/tour_stations.h"
#include "plan/routes/station_order.h"

namespace patrol::app {

struct TourStop {
  io::TourStation station;
  Eigen::Vector2d p_m = Eigen::Vector2d::Zero();  ///< in the grid's frame
};

/// Visit of a planned tour. Times are from the tour's start.
struct TourVisit {
  std::size_t node = 0;  ///< 0: start, 1 ... n: stops, n + 1: end, if it differs from the start
  double leg_m = 0.0;    ///< length of the path to it
  double arrives_s = 0.0, waits_s = 0.0, leaves_s = 0.0, late_s = 0.0;
};

struct TourPlan {
  plan::TourOrder order;                  ///< order of the reachable stations, by their own indices
  std::vector<TourVisit> visits;          ///< in order, from the start to the end, or back to the start
  std::vector<std::size_t> unreachable;   ///< places without a path from the start
  bool is_proven = true;                  ///< whether unreachability is proven; false with an incomplete planner
  std::vector<Eigen::Vector2d> points_m;  ///< the whole path, in the grid's frame
  int num_routes = 0;                     ///< number of planned paths
  double processor_s = 0.0;               ///< processor time of planning
};

/// Orders the stops from the start, ending at `p_end_m` or else back at the start. Travel costs come from the settings'
/// planner for all pairs. A path is planned in one direction and driven in both, at equal cost. Unreachable stops are
/// omitted. None if interrupted.
std::optional<TourPlan> plan_tour(const Grid<plan::Cost>& costs, const Eigen::Vector2d& p_start_m,
                                  const std::vector<TourStop>& stops, const std::optional<Eigen::Vector2d>& p_end_m,
                                  const PlanSettings& settings);

}  // namespace patrol::app
