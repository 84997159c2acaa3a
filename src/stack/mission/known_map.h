#pragma once

#include <optional>
#include <string>
#include <vector>

#include "core/grid.h"
#include "core/route.h"

namespace patrol::stack {

/// What a robot asks of a map that it is given: something to stand on, something to see, and the surveyed start, map's origin, on it.
/// Throws InputError that names `file`.
void check_known_map(const std::string& file, const OccupancyGrid& map);

/// Goals shall lie on the map; where it is still to be made, no more than 1 km from the start. One in a wall or in what the map does
/// not know is the navigation's to refuse, when it gets there. Throws InputError that names `file` and the goal.
void check_goals(const std::string& file, const std::vector<MarkedGoal>& goals, const std::optional<OccupancyGrid>& map);

}  // namespace patrol::stack
