#pragma once

#include <string>
#include <vector>

#include <mujoco/mujoco.h>

#include "importer/assumptions.h"
#include "importer/site/imported_site.h"

namespace patrol::importer {

/// Throws InputError with the source and the geom if a geom reaches beyond `kMaxCoordinate_m`.
void check_coordinates(const mjModel& model, const std::string& source);

/// Returns rows about the compiled model of a site. "no ground": neither a plane nor a height field has contact, and no
/// other shape is large, or low and level. "low obstacles": shapes with contact that are higher than a curb and end
/// below the lidar of the robot, if lidars see nothing within 0.25 m beside them at the height of the lidar. Heights
/// are those above the lowest floor within 1 m.
std::vector<Assumption> rows_of_compiled(const mjModel& model, const ImportedSite& site);

}  // namespace patrol::importer
