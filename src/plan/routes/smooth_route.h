#pragma once

#include <vector>

#include <Eigen/Core>

#include "core/grid.h"
#include "plan/perception/costmap.h"

namespace patrol::plan {

/// Replaces segments of a route between cell centers by straight lines. A line must touch no lethal cell, not even at a
/// corner, and must not cost more than its segment. Its clearance must reach the segment's clearance or
/// `min_clearance`, cells, whichever is smaller. Points are in cells, as in Route.
std::vector<Eigen::Vector2d> smooth_route(const Grid<Cost>& costs, double cost_weight, double min_clearance,
                                          const std::vector<Eigen::Vector2d>& points);

}  // namespace patrol::plan
