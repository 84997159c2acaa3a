#include "io/json/teleop_route_json.h"

#include <cmath>

#include <fmt/format.h>

#include "core/error.h"
#include "core/geometry/angles.h"
#include "io/json/json_object.h"

namespace patrol::io {
namespace {

constexpr double kMaxLeg_m = 1000.0;

TeleopWaypoint read_waypoint(const std::string& place, const Json& json) {
  const JsonObject reader(place, json, {"position", "reverse", "mark_heading_deg"});
  const std::vector<double> p = reader.numbers("position", 2);
  TeleopWaypoint waypoint{.p_m = {p[0], p[1]}};
  if (reader.has("reverse")) waypoint.is_reverse = reader.boolean("reverse");
  if (reader.has("mark_heading_deg")) {
    waypoint.is_goal = true;
    const double heading_deg = reader.number("mark_heading_deg");
    if (std::abs(heading_deg) > 360.0) reader.fail("mark_heading_deg must be in [-360, 360]");
    waypoint.heading_rad = to_rad(heading_deg);
  }
  return waypoint;
}

}  // namespace

TeleopRoute load_teleop_route(const std::filesystem::path& file) {
  const Json json = load_json(file);
  const JsonObject root(file.string(), json, {"version", "frame", "waypoints"});
  if (root.integer("version") != 1) root.fail("version must be 1");
  if (root.string("frame") != "site") root.fail("frame must be site");
  const Json& waypoints = root.list("waypoints");
  TeleopRoute drive;
  for (std::size_t i = 0; i < waypoints.size(); ++i) {
    const std::string place = fmt::format("{}: waypoints[{}]", file.string(), i);
    drive.push_back(read_waypoint(place, waypoints[i]));
    if (i > 0 && (drive[i].p_m - drive[i - 1].p_m).norm() > kMaxLeg_m) {
      throw InputError(fmt::format("{}: position is more than {} m from the one before", place, kMaxLeg_m));
    }
  }
  if (drive.size() < 2) root.fail("waypoints must be at least two");
  return drive;
}

}  // namespace patrol::io
