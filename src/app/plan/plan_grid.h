#pragma once

#include <cstdint>
#include <optional>

#include <Eigen/Core>

#include "app/plan/plan_settings.h"
#include "core/grid.h"
#include "plan/perception/costmap.h"

namespace patrol::app {

/// Cost grid for the planners. For a point: the cells of the map, lethal if occupied, or if unknown cells may not be
/// crossed. For an outline: the costmap of a robot (plan/perception/costmap.h), without scan obstacles and keep-out
/// lines, cut to the map. Its cells are at least as large as the map's. Throws InputError if the outline is too large
/// for the costmap.
Grid<plan::Cost> make_costs(const OccupancyGrid& occupancy, const PlanBody& body,
                            const plan::CostmapSettings& settings);

std::int64_t num_passable(const Grid<plan::Cost>& costs);

/// Passable cell nearest to a position, at any distance; none if all cells are lethal.
std::optional<Cell> nearest_free(const Grid<plan::Cost>& costs, const Eigen::Vector2d& p_m);

/// Reason why a position is blocked, for messages: "is occupied".
const char* blocked_reason(const OccupancyGrid& occupancy, const plan::CostmapSettings& settings,
                           const Eigen::Vector2d& p_m);

}  // namespace patrol::app
