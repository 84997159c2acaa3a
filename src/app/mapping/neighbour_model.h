#pragma once

#include <filesystem>

#include "core/boosted_stumps.h"
#include "slam/mapper.h"

namespace patrol::app {

/// Where `patrol train-neighbours` leaves, and mapping looks for, what recognises neighbouring submaps: below the data root.
inline constexpr const char* kNeighbourModel = "models/submap_neighbours.json";

/// For the method that asks for it; none for others. Throws InputError with the file's place.
BoostedStumps neighbours_for(const slam::MapperSettings& settings);

}  // namespace patrol::app
