#pragma once

#include <filesystem>

#include "core/remote_drive.h"

namespace patrol::io {

/// Where the person at the remote control drives: {"version": 1, "frame": "site", "waypoints": [{"position": [x, y],
/// "reverse": bool?, "mark_heading_deg": number?}, ...]}, metres; a waypoint with a heading is marked as a goal. At least two, no more
/// than 1 km apart.
/// Throws InputError with the file, the waypoint and the key.
RemoteDrive load_drive(const std::filesystem::path& file);

}  // namespace patrol::io
