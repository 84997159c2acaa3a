#pragma once

#include <vector>

#include "importer/site/points/patch.h"
#include "importer/site/points/scanned_ground.h"

namespace patrol::importer {

/// Returns patches of the interpolated cells, filled in, flat within 4 mm.
std::vector<Patch> filled_ground(const ScannedGround& ground, float reflectivity);

}  // namespace patrol::importer
