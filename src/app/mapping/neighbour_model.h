#pragma once

#include <filesystem>
#include <string>

#include "core/boosted_stumps.h"

namespace patrol::app {

/// Where `patrol train-neighbours` leaves, and mapping looks for, what recognises neighbouring submaps: below the data root.
inline constexpr const char* kNeighbourModel = "models/submap_neighbours.json";

/// Whether the SLAM method of that name classifies pairs of submaps.
bool needs_neighbor_model(const std::string& method);

/// Model for the SLAM method of that name; empty for methods that need none. Throws InputError with the file's place.
BoostedStumps neighbours_for(const std::string& method, const std::filesystem::path& data_root);

}  // namespace patrol::app
