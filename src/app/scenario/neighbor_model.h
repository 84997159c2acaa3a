#pragma once

#include <filesystem>
#include <string>

#include "core/boosted_stumps.h"

namespace patrol::app {

/// Path of the classifier of neighboring submaps below the data root; written by `patrol train-neighbors`, read by
/// mapping.
inline constexpr const char* kNeighborModel = "models/submap_neighbors.json";

/// Whether the SLAM method of that name classifies pairs of submaps.
bool needs_neighbor_model(const std::string& method);

/// Loads the model for the SLAM method of that name; empty for methods that need none. Throws InputError with the
/// file's path.
BoostedStumps load_neighbor_model(const std::string& method, const std::filesystem::path& data_root);

}  // namespace patrol::app
