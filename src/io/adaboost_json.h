#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "core/boosted_stumps.h"

namespace patrol::io {

/// A trained vote of stumps: {"features": ["name", ...], "stumps": [{"feature": "name", "threshold": float, "sign_above": 1 or -1, "weight": float > 0}, ...]}.
/// Numbers are written so that the same ones are read back. At most 10,000 stumps.
/// Throws InputError with the file, the entry and the key; also when the features are not those `expected`, in their order.
BoostedStumps load_boosted_stumps(const std::filesystem::path& file, const std::vector<std::string>& expected_features);

void save_boosted_stumps(const std::filesystem::path& file, const BoostedStumps& model);

}  // namespace patrol::io
