#include "io/route_json.h"

#include <algorithm>
#include <cmath>
#include <set>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "core/error.h"
#include "io/atomic_file.h"
#include "io/settings_yaml.h"

namespace patrol::io {
namespace {

using Json = nlohmann::json;

/// Reads members of one object and knows where it is.
class ObjectReader {
 public:
  ObjectReader(std::string place, const Json& json, std::vector<std::string> keys) : place_(std::move(place)), json_(json) {
    if (!json.is_object()) fail("must be an object");
    for (const auto& [key, value] : json.items()) {
      if (std::find(keys.begin(), keys.end(), key) != keys.end()) continue;
      const std::string nearest = nearest_word(key, keys);
      fail(fmt::format("unknown key {}{}", key, nearest.empty() ? "" : "; did you mean " + nearest + "?"));
    }
  }

  const Json& member(const char* key) const {
    if (!json_.contains(key)) fail(fmt::format("{} is missing", key));
    return json_.at(key);
  }
  bool has(const char* key) const { return json_.contains(key); }
  int whole(const char* key) const {
    if (!member(key).is_number_integer()) fail(fmt::format("{} must be a whole number", key));
    return member(key).get<int>();
  }
  double number(const char* key) const {
    if (!member(key).is_number()) fail(fmt::format("{} must be a number", key));
    return member(key).get<double>();
  }
  std::string word(const char* key) const {
    if (!member(key).is_string()) fail(fmt::format("{} must be a word", key));
    return member(key).get<std::string>();
  }
  std::vector<double> numbers(const char* key, std::size_t count) const { return numbers_of(member(key), key, count); }
  std::vector<double> numbers_of(const Json& json, const char* key, std::size_t count) const {
    if (!json.is_array() || json.size() != count) fail(fmt::format("{} must be a list of {} numbers", key, count));
    std::vector<double> values;
    for (const Json& value : json) {
      if (!value.is_number() || !std::isfinite(value.get<double>())) fail(fmt::format("{} must be a list of {} numbers", key, count));
      values.push_back(value.get<double>());
    }
    return values;
  }
  Pose2 pose() const {
    const std::vector<double> p = numbers("position", 3), q = numbers("orientation", 4);
    const Eigen::Quaterniond rotation(q[3], q[0], q[1], q[2]);
    if (std::abs(rotation.norm() - 1.0) > 1e-3) fail("orientation must be a quaternion x, y, z, w of length 1");
    return {p[0], p[1], yaw_of(rotation)};
  }
  [[noreturn]] void fail(const std::string& what) const { throw InputError(place_ + ": " + what); }

 private:
  std::string place_;
  const Json& json_;
};

Station read_station(const std::string& place, const Json& json) {
  const ObjectReader reader(place, json, {"number", "name", "type", "position", "orientation", "target", "accuracy"});
  Station station{.number = reader.whole("number"), .name = reader.word("name"), .type = reader.word("type"),
                  .T_route_body = reader.pose(), .p_route_target = {}, .accuracy_m = reader.number("accuracy")};
  if (station.type != "inspect" && station.type != "pass" && station.type != "home") {
    reader.fail(fmt::format("type = {}: must be one of inspect, pass, home", station.type));
  }
  if (station.accuracy_m <= 0.0) reader.fail("accuracy must be positive");
  if (reader.has("target")) {
    const std::vector<double> target = reader.numbers("target", 3);
    station.p_route_target = {target[0], target[1], target[2]};
  } else if (station.type == "inspect") {
    reader.fail("target is missing: what an inspection looks at");
  }
  return station;
}

/// Events and scores name stations: each name and number stands for one.
void check_unique(const std::string& file, const std::vector<Station>& stations) {
  std::set<std::string> names;
  std::set<int> numbers;
  for (std::size_t i = 0; i < stations.size(); ++i) {
    const auto refuse = [&](const std::string& what) {
      throw InputError(fmt::format("{}: stations[{}]: {} stands there twice", file, i, what));
    };
    if (!names.insert(stations[i].name).second) refuse("name " + stations[i].name);
    if (!numbers.insert(stations[i].number).second) refuse(fmt::format("number {}", stations[i].number));
  }
}

std::vector<Eigen::Vector2d> read_line(const std::string& place, const Json& json) {
  const ObjectReader reader(place, json, {"name", "line"});
  std::vector<Eigen::Vector2d> line;
  if (!reader.member("line").is_array()) reader.fail("line must be a list of points");
  for (const Json& point : reader.member("line")) {
    const std::vector<double> p = reader.numbers_of(point, "a point of line", 2);
    line.emplace_back(p[0], p[1]);
  }
  if (line.size() < 2) reader.fail("line must have at least two points");
  return line;
}

Json parse(const std::filesystem::path& file) {
  const std::string text = load_text(file);
  try {
    return Json::parse(text);
  } catch (const Json::parse_error& error) {
    throw InputError(fmt::format("{}: is not JSON at byte {}", file.string(), error.byte));
  }
}

}  // namespace

RouteFile load_route(const std::filesystem::path& file) {
  const Json json = parse(file);
  const std::string name = file.string();
  const ObjectReader root(name, json, {"version", "frame", "start", "stations", "keep_out"});
  if (root.whole("version") != 1) root.fail("version must be 1");
  if (root.word("frame") != "site") root.fail("frame must be site");
  RouteFile route{.route = {}, .T_site_start = ObjectReader(name + ": start", root.member("start"), {"position", "orientation"}).pose()};
  const Json& stations = root.member("stations");
  if (!stations.is_array() || stations.empty()) root.fail("stations must be a list with at least one entry");
  for (std::size_t i = 0; i < stations.size(); ++i) {
    route.route.stations.push_back(read_station(fmt::format("{}: stations[{}]", name, i), stations[i]));
  }
  check_unique(name, route.route.stations);
  if (root.has("keep_out")) {
    if (!root.member("keep_out").is_array()) root.fail("keep_out must be a list");
    for (std::size_t i = 0; i < root.member("keep_out").size(); ++i) {
      route.route.keep_out_lines.push_back(read_line(fmt::format("{}: keep_out[{}]", name, i), root.member("keep_out")[i]));
    }
  }
  return route;
}

}  // namespace patrol::io
