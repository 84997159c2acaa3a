#include "io/json/route_json.h"

#include <algorithm>
#include <cmath>
#include <set>
#include <stdexcept>

#include <fmt/format.h>

#include "core/error.h"
#include "io/json/json_object.h"

namespace patrol::io {
namespace {

constexpr double kMaxWindow_s = 1e7;

Station read_station(const std::string& place, const Json& json) {
  const JsonObject reader(
      place, json, {"number", "name", "type", "position", "orientation", "target", "accuracy", "priority", "window"});
  Station station{.number = reader.integer("number"),
                  .name = reader.string("name"),
                  .type = reader.choice("type", kStationTypes),
                  .T_route_body = reader.pose(),
                  .p_route_target = {},
                  .accuracy_m = reader.number("accuracy")};
  if (station.accuracy_m <= 0.0) reader.fail("accuracy must be positive");
  if (reader.has("target")) {
    const std::vector<double> target = reader.numbers("target", 3);
    station.p_route_target = {target[0], target[1], target[2]};
  } else if (station.type == StationType::kInspect) {
    reader.fail("target is missing: what an inspection looks at");
  }
  if (reader.has("priority")) station.priority = reader.integer("priority");
  if (reader.has("window")) {
    const std::vector<double> window = reader.numbers("window", 2);
    station.earliest_s = window[0], station.latest_s = window[1];
    if (station.earliest_s < 0.0 || station.latest_s < station.earliest_s || station.latest_s > kMaxWindow_s) {
      reader.fail("window must be two times in s, from 0 to 1e7 and in order");
    }
  }
  return station;
}

/// Checks that station names and numbers are unique, because events and scores refer to stations by them.
void check_unique(const std::string& file, const std::vector<Station>& stations) {
  std::set<std::string> names;
  std::set<int> numbers;
  for (std::size_t i = 0; i < stations.size(); ++i) {
    const auto refuse = [&](const std::string& what) {
      throw InputError(fmt::format("{}: stations[{}]: {}: duplicate", file, i, what));
    };
    if (!names.insert(stations[i].name).second) refuse("name " + stations[i].name);
    if (!numbers.insert(stations[i].number).second) refuse(fmt::format("number {}", stations[i].number));
  }
}

std::vector<Eigen::Vector2d> read_line(const std::string& place, const Json& json) {
  return JsonObject(place, json, {"name", "line"}).polyline("line");
}

std::vector<UwbAnchor> read_anchors(const std::string& place, const Json& json) {
  std::vector<UwbAnchor> anchors;
  std::set<int> numbers;
  for (std::size_t i = 0; i < json.size(); ++i) {
    const JsonObject reader(fmt::format("{}: anchors[{}]", place, i), json[i], {"number", "position"});
    const std::vector<double> p = reader.numbers("position", 3);
    anchors.push_back({.number = reader.integer("number"), .p_m = {p[0], p[1], p[2]}});
    if (!numbers.insert(anchors.back().number).second)
      reader.fail(fmt::format("number {}: duplicate", anchors.back().number));
  }
  return anchors;
}

Dock read_dock(const std::string& place, const Json& json) {
  const JsonObject reader(place + ": dock", json, {"position", "orientation", "profile"});
  return {.T_route_docked = reader.pose(), .profile_m = reader.polyline("profile")};
}

TunnelLining read_lining(const std::string& file, const Json& json) {
  const std::string place = file + ": lining";
  const JsonObject reader(place, json,
                          {"position", "orientation", "axis", "crown_radius", "crown_center", "side_radius",
                           "first_ring", "ring_length", "rings"});
  TunnelLining lining{.T_route_start = reader.pose(),
                      .axis = {},
                      .crown_radius_m = reader.number("crown_radius"),
                      .crown_center_m = reader.number("crown_center"),
                      .side_radius_m = reader.number("side_radius"),
                      .first_ring_m = reader.number("first_ring"),
                      .ring_length_m = reader.number("ring_length"),
                      .rings = reader.integer("rings")};
  const Json& axis = reader.list("axis");
  for (std::size_t i = 0; i < axis.size(); ++i) {
    const JsonObject element(fmt::format("{}: axis[{}]", place, i), axis[i], {"length", "curvature"});
    lining.axis.push_back({.length_m = element.number("length"), .curvature_1pm = element.number("curvature")});
    if (lining.axis.back().length_m <= 0.0) element.fail("length must be positive");
  }
  if (lining.axis.empty()) reader.fail("axis must have at least one element");
  if (lining.crown_radius_m <= 0.0) reader.fail("crown_radius must be positive");
  if (lining.side_radius_m < lining.crown_radius_m) reader.fail("side_radius must be at least crown_radius");
  if (lining.ring_length_m <= 0.0) reader.fail("ring_length must be positive");
  if (lining.rings < 1) reader.fail("rings must be at least 1");
  return lining;
}

GeodeticDatum read_datum(const std::string& file, const Json& json) {
  const JsonObject reader(file + ": datum", json, {"latitude_deg", "longitude_deg"});
  const GeodeticDatum datum{.latitude_deg = reader.number("latitude_deg"),
                            .longitude_deg = reader.number("longitude_deg")};
  // Near the poles the radius of a parallel changes too fast for the conversion.
  if (std::abs(datum.latitude_deg) > 85.0) reader.fail("latitude_deg must be in [-85, 85]");
  if (std::abs(datum.longitude_deg) > 180.0) reader.fail("longitude_deg must be in [-180, 180]");
  return datum;
}

nlohmann::ordered_json pose_members(const Pose2& pose) {
  return {{"position", {pose.x, pose.y, 0.0}},
          {"orientation", {0.0, 0.0, std::sin(pose.yaw / 2.0), std::cos(pose.yaw / 2.0)}}};
}

}  // namespace

RouteFile load_route(const std::filesystem::path& file) {
  const Json json = load_json(file);
  const std::string name = file.string();
  const JsonObject root(name, json,
                        {"version", "frame", "start", "stations", "keep_out", "anchors", "dock", "lining", "datum"});
  if (root.integer("version") != 1) root.fail("version must be 1");
  if (root.string("frame") != "site") root.fail("frame must be site");
  RouteFile route{.route = {},
                  .T_site_start =
                      JsonObject(name + ": start", root.member("start"), {"position", "orientation"}).pose(),
                  .datum = {}};
  const Json& stations = root.list("stations");
  for (std::size_t i = 0; i < stations.size(); ++i) {
    route.route.stations.push_back(read_station(fmt::format("{}: stations[{}]", name, i), stations[i]));
  }
  check_unique(name, route.route.stations);
  if (root.has("keep_out")) {
    const Json& lines = root.list("keep_out");
    for (std::size_t i = 0; i < lines.size(); ++i) {
      route.route.keep_out_lines.push_back(read_line(fmt::format("{}: keep_out[{}]", name, i), lines[i]));
    }
  }
  if (root.has("anchors")) route.route.anchors = read_anchors(name, root.list("anchors"));
  if (root.has("dock")) route.route.dock = read_dock(name, root.member("dock"));
  if (root.has("lining")) route.route.lining = read_lining(name, root.member("lining"));
  if (root.has("datum")) route.datum = read_datum(name, root.member("datum"));
  return route;
}

std::string to_json_text(const Route& route, const Pose2& T_site_start) {
  if (!route.keep_out_lines.empty() || !route.anchors.empty() || route.dock || route.lining)
    throw std::invalid_argument("to_json_text: only start and stations are written");
  nlohmann::ordered_json json = {{"version", 1}, {"frame", "site"}, {"start", pose_members(T_site_start)}};
  json["stations"] = nlohmann::ordered_json::array();
  for (const Station& station : route.stations) {
    nlohmann::ordered_json entry = {
        {"number", station.number}, {"name", station.name}, {"type", name_of(station.type)}};
    entry.update(pose_members(station.T_route_body));
    entry["accuracy"] = station.accuracy_m;
    if (station.priority != 0) entry["priority"] = station.priority;
    if (station.earliest_s > 0.0 || std::isfinite(station.latest_s))
      entry["window"] = {station.earliest_s, std::min(station.latest_s, kMaxWindow_s)};
    if (station.type == StationType::kInspect) {
      const Eigen::Vector3d& target = station.p_route_target;
      entry["target"] = {target.x(), target.y(), target.z()};
    }
    json["stations"].push_back(entry);
  }
  return json.dump(1) + "\n";
}

}  // namespace patrol::io
