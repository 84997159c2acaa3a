#pragma once

#include <filesystem>
#include <vector>

#include "core/route.h"

namespace patrol::io {

/// nav.json, the goals that were marked by driving there (paper 004, table 1): a list of {"number": int, "position": float[3],
/// "orientation": float[4] (x, y, z, w), "type": char, "accuracy": float}, in `map`, metres. At least one goal, at most 1,000.
/// Throws InputError with the file, the entry and the key.
std::vector<MarkedGoal> load_nav(const std::filesystem::path& file);

void save_nav(const std::filesystem::path& file, const std::vector<MarkedGoal>& goals);

}  // namespace patrol::io
