#pragma once

#include <filesystem>
#include <optional>
#include <string>

#include "core/route.h"
#include "core/site/geodetic_datum.h"

namespace patrol::io {

struct RouteFile {
  Route route;         ///< in site
  Pose2 T_site_start;  ///< surveyed start pose of the robot
  std::optional<GeodeticDatum> datum;
};

/// Reads a mission file: {"version": 1, "frame": "site", "start": {"position": [x, y, z], "orientation": [x, y, z, w]},
/// "stations": [{"number", "name", "type", "position", "orientation", "target", "accuracy"}], "keep_out": [{"name",
/// "line": [[x, y], ...]}], "datum": {"latitude_deg", "longitude_deg"}}. Positions are in meters; orientations are
/// quaternions about z. The optional datum is the WGS 84 position of the origin, with x to the east and y to the north.
/// Throws InputError with file and JSON path.
RouteFile load_route(const std::filesystem::path& file);

/// Returns start and stations of a route as the text of a mission file. Its other parts must be empty.
std::string to_json_text(const Route& route, const Pose2& T_site_start);

}  // namespace patrol::io
