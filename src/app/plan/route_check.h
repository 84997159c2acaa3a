#pragma once

#include <optional>
#include <string>

#include "core/grid.h"
#include "plan/routes/route_planner.h"

namespace patrol::app {

/// Validates a route from cell to cell; returns a description of the first fault, or none. The route must begin and end
/// at the cells' centers, turn only at centers or corners of cells, and meet no lethal cell. Each leg is intersected,
/// row by row, with the closed squares of lethal cells, exactly in integers. The check uses none of the planners' code.
///
/// `may_touch`, for the any-angle optimum: the route may touch squares, but not pass between two that meet; outside of
/// the grid everything is lethal.
std::optional<std::string> validate_route(const Grid<plan::Cost>& costs, const plan::Route& route, Cell start,
                                          Cell goal, bool may_touch);

}  // namespace patrol::app
