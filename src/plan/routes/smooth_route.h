#pragma once

#include <Eigen/Core>

#include <vector>

#include "core/grid.h"
#include "plan/perception/costmap.h"

namespace patrol::plan {

/// Replaces stretches of a route between cells' centres by straight lines wherever these meet no lethal cell, not even at a corner, come no nearer to one than the
/// stretch did (as far as `kept_clearance`, cells), and cost no more. Points are in cells, as in Route.
std::vector<Eigen::Vector2d> smooth_route(const Grid<Cost>& costs, double cost_weight, double kept_clearance, const std::vector<Eigen::Vector2d>& points);

}  // namespace patrol::plan
