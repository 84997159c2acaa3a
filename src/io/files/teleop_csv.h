#pragma once

#include <filesystem>
#include <vector>

#include "core/sensors/registry.h"

namespace patrol::io {

/// Reads recorded teleoperation commands: a table with the header "time_s,vx_mps,yaw_rate_radps,mark,hand_over", with
/// increasing times and buttons 0 or 1. Throws InputError with file and line.
std::vector<TeleopCommand> load_teleop(const std::filesystem::path& file);

void save_teleop(const std::filesystem::path& file, const std::vector<TeleopCommand>& commands);

}  // namespace patrol::io
