#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "core/boosted_stumps.h"

namespace patrol::io {

/// Reads a boosted classifier from JSON: {"features": ["name", ...], "stumps": [{"feature": "name", "threshold": float,
/// "sign_above": 1 or -1, "weight": float > 0}, ...]}. At most 10,000 stumps.
/// Throws InputError with file, entry and key, also if the features differ from `expected_features` in names or order.
BoostedStumps load_boosted_stumps(const std::filesystem::path& file, const std::vector<std::string>& expected_features);

/// Writes a boosted classifier as JSON. Numbers are written such that reading returns the same values.
void save_boosted_stumps(const std::filesystem::path& file, const BoostedStumps& model);

}  // namespace patrol::io
