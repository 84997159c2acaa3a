#pragma once

#include <filesystem>

#include "core/teleop_route.h"

namespace patrol::io {

/// Reads a teleoperated drive: {"version": 1, "frame": "site", "waypoints": [{"position": [x, y], "reverse": bool?,
/// "mark_heading_deg": number?}, ...]}, in meters. A waypoint with a heading is saved as a goal. At least two
/// waypoints, at most 1 km apart.
/// Throws InputError with file, waypoint and key.
TeleopRoute load_teleop_route(const std::filesystem::path& file);

}  // namespace patrol::io
