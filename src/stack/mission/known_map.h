#pragma once

#include <optional>
#include <string>
#include <vector>

#include "core/grid.h"
#include "core/route.h"

namespace patrol::stack {

/// Checks a given map: it must have a free cell, an occupied cell, and the surveyed start, map's origin, inside. Throws
/// InputError that names `file`.
void validate_map(const std::string& file, const OccupancyGrid& map);

/// Checks that goals are inside the map or, if the map is still to be made, at most 1 km from the start. Goals inside
/// walls or in unknown space are rejected later by the navigation. Throws InputError that names `file` and the goal.
void validate_goals(const std::string& file, const std::vector<SavedGoal>& goals,
                    const std::optional<OccupancyGrid>& map);

}  // namespace patrol::stack
