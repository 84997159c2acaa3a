#pragma once

#include <filesystem>

#include "core/route.h"

namespace patrol::io {

struct RouteFile {
  Route route;          ///< in site
  Pose2 T_site_start;   ///< where the survey says that the robot starts
};

/// A mission file: {"version": 1, "frame": "site", "start": {"position": [x, y, z], "orientation": [x, y, z, w]}, "stations":
/// [{"number", "name", "type", "position", "orientation", "target", "accuracy"}], "keep_out": [{"name", "line": [[x, y], ...]}]}.
/// Metres; orientations are quaternions about z. Throws InputError with the file and the place in it.
RouteFile load_route(const std::filesystem::path& file);

}  // namespace patrol::io
