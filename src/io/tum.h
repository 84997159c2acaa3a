#pragma once

#include <filesystem>

#include "core/trajectory.h"

namespace patrol::io {

/// TUM trajectories: "seconds x y z qx qy qz qw", one pose a line, stamps growing; '#' begins a comment.
/// Throws InputError with file and line for anything else.
Trajectory load_tum(const std::filesystem::path& file);
void save_tum(const std::filesystem::path& file, const Trajectory& trajectory, const std::string& comment);

}  // namespace patrol::io
