#pragma once

#include <filesystem>
#include <vector>

#include "core/route.h"

namespace patrol::io {

/// Reads nav.json, the goals saved by teleoperation [Liu21, table 1]. Format: a list of {"number": int, "position":
/// float[3], "orientation": float[4] (x, y, z, w), "type": char, "accuracy": float}, in `map`, in meters. At least one
/// goal, at most 1,000.
/// Throws InputError with file, entry and key.
std::vector<SavedGoal> load_nav(const std::filesystem::path& file);

void save_nav(const std::filesystem::path& file, const std::vector<SavedGoal>& goals);

}  // namespace patrol::io
