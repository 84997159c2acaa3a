#pragma once

#include <optional>
#include <string>

#include "core/grid.h"
#include "plan/routes/route_planner.h"

namespace patrol::app {

/// What is wrong with a route from cell to cell; none if nothing is. It must begin and end at the cells' centres, turn only at centres or corners of
/// cells, and meet no lethal cell: each leg is cut, row by row, with the lethal cells' closed squares, exact in whole numbers. Nothing of the planners'
/// own code is used.
///
/// `may_touch`, for the any-angle optimum: squares may be touched, but not passed between where two meet; outside the grid all is lethal.
std::optional<std::string> find_fault(const Grid<plan::Cost>& costs, const plan::Route& route, Cell start, Cell goal, bool may_touch);

}  // namespace patrol::app
