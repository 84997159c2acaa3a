#pragma once

#include <Eigen/Core>

#include <cstdint>
#include <optional>

#include "app/plan/plan_settings.h"
#include "core/grid.h"
#include "plan/perception/costmap.h"

namespace patrol::app {

/// What the planners get. For a point the map's own cells: lethal what is occupied, or unknown and not to be crossed. For an outline the costmap
/// that a robot drives by (plan/perception/costmap.h), without live obstacles and keep-out lines, cut to the map; its cells are no finer than the map's.
/// Throws InputError when the outline is too large for the costmap's reach.
Grid<plan::Cost> make_costs(const OccupancyGrid& occupancy, const PlanBody& body, const plan::CostmapSettings& settings);

std::int64_t num_passable(const Grid<plan::Cost>& costs);

/// The passable cell nearest to a place, however far; none if there is none at all.
std::optional<Cell> nearest_free(const Grid<plan::Cost>& costs, const Eigen::Vector2d& p_m);

/// Why nothing can stand there, as a person would say it: "is occupied".
const char* blocked_reason(const OccupancyGrid& occupancy, const plan::CostmapSettings& settings, const Eigen::Vector2d& p_m);

}  // namespace patrol::app
