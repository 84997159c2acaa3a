#pragma once

#include <filesystem>

#include "core/route.h"

namespace patrol::io {

struct RouteFile {
  Route route;         ///< in site
  Pose2 T_site_start;  ///< surveyed start pose of the robot
};

/// Reads a mission file: {"version": 1, "frame": "site", "start": {"position": [x, y, z], "orientation": [x, y, z, w]},
/// "stations": [{"number", "name", "type", "position", "orientation", "target", "accuracy"}], "keep_out": [{"name",
/// "line": [[x, y], ...]}]}. Positions are in meters; orientations are quaternions about z. Throws InputError with file
/// and JSON path.
RouteFile load_route(const std::filesystem::path& file);

}  // namespace patrol::io
