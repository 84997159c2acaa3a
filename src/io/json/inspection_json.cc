#include "io/json/inspection_json.h"

#include <cmath>
#include <limits>
#include <vector>

#include <fmt/format.h>

#include "io/json/json_object.h"

namespace patrol::io {
namespace {

constexpr int kMaxRings = 100'000;

Json number_or_null(double value) { return std::isfinite(value) ? Json(value) : Json(nullptr); }

double read_number(const JsonObject& object, const char* key) {
  return object.member(key).is_null() ? std::numeric_limits<double>::quiet_NaN() : object.number(key);
}

/// Reads a length, a standard deviation or a ratio; must not be negative.
double read_non_negative(const JsonObject& object, const char* key) {
  const double value = read_number(object, key);
  if (value < 0.0) object.fail(fmt::format("{} must not be negative", key));
  return value;
}

int count_of(const JsonObject& object, const char* key) {
  const int count = object.integer(key);
  if (count < 0) object.fail(fmt::format("{} must not be negative", key));
  return count;
}

int ring_of(const JsonObject& object) {
  const int ring = object.integer("ring");
  if (ring < 1 || ring > kMaxRings) object.fail(fmt::format("ring must be in [1, {}]", kMaxRings));
  return ring;
}

double clock_of(const JsonObject& object) {
  const double clock_deg = object.number("clock_deg");
  if (clock_deg < 0.0 || clock_deg > 360.0) object.fail("clock_deg must be in [0, 360]");
  return clock_deg;
}

WarningLevel level_of(const JsonObject& object) { return object.choice("level", kWarningLevels); }

Time stamp_of(const JsonObject& object) {
  const Json& stamp = object.member("stamp_ns");
  if (!stamp.is_number_integer()) object.fail("stamp_ns must be an integer");
  return Time{stamp.get<std::int64_t>()};
}

Json point(const Eigen::Vector3d& p) { return {number_or_null(p.x()), number_or_null(p.y()), number_or_null(p.z())}; }

Eigen::Vector3d point_of(const JsonObject& object, const char* key) {
  const std::vector<double> p = object.numbers(key, 3);
  return {p[0], p[1], p[2]};
}

/// Reads each entry of a list with `read(JsonObject)`.
template <typename Entry, typename Read>
std::vector<Entry> entries(const JsonObject& object, const char* list, const std::string& place,
                           const std::vector<std::string>& keys, Read read) {
  std::vector<Entry> all;
  for (const Json& json : object.list(list))
    all.push_back(read(JsonObject(fmt::format("{}.{}[{}]", place, list, all.size()), json, keys)));
  return all;
}

/// Adds the fields of a detected body of water.
void add_body(Json& json, const WaterResult& result) {
  json["position_m"] = point(result.p_map);
  for (int row = 0; row < 3; ++row) json["covariance_m2"].push_back(point(result.covariance_m2.row(row)));
  json["distance_m"] = number_or_null(result.distance_m);
  json["distance_interval_m"] = {number_or_null(result.distance_low_m), number_or_null(result.distance_high_m)};
  json["azimuth_deg"] = number_or_null(result.azimuth_deg);
  json["elevation_deg"] = number_or_null(result.elevation_deg);
  json["radius_m"] = number_or_null(result.radius_m);
  json["radius_interval_m"] = {number_or_null(result.radius_low_m), number_or_null(result.radius_high_m)};
}

void read_body(const JsonObject& object, WaterResult& result) {
  result.p_map = point_of(object, "position_m");
  const Json& rows = object.list("covariance_m2");
  if (rows.size() != 3) object.fail("covariance_m2 must be a list of 3 lists of 3 numbers");
  for (int row = 0; row < 3; ++row) {
    const Json wrapped = {{"covariance_m2", rows[static_cast<std::size_t>(row)]}};
    result.covariance_m2.row(row) = point_of(JsonObject("covariance_m2", wrapped, {"covariance_m2"}), "covariance_m2");
  }
  const std::vector<double> distance_m = object.numbers("distance_interval_m", 2),
                            radius_m = object.numbers("radius_interval_m", 2);
  result.distance_m = read_non_negative(object, "distance_m");
  result.distance_low_m = distance_m[0];
  result.distance_high_m = distance_m[1];
  result.azimuth_deg = object.number("azimuth_deg");
  result.elevation_deg = object.number("elevation_deg");
  result.radius_m = read_non_negative(object, "radius_m");
  result.radius_low_m = radius_m[0];
  result.radius_high_m = radius_m[1];
}

}  // namespace

Json to_json(const Pose2& T_map_body) { return {{"x", T_map_body.x}, {"y", T_map_body.y}, {"yaw", T_map_body.yaw}}; }

Pose2 pose_from_json(const std::string& place, const Json& json) {
  const JsonObject object(place, json, {"x", "y", "yaw"});
  return {object.number("x"), object.number("y"), object.number("yaw")};
}

Json to_json(const LiningResult& result) {
  Json json = {{"stamp_ns", result.stamp.count()},
               {"station", result.station},
               {"pose", to_json(result.T_map_body)},
               {"registered", result.is_registered},
               {"registration_rms_m", number_or_null(result.registration_rms_m)},
               {"registration_inlier_ratio", number_or_null(result.registration_inlier_ratio)},
               {"correction_m", number_or_null(result.correction_m)},
               {"cells", Json::array()},
               {"lines", Json::array()},
               {"findings", Json::array()}};
  for (const LiningCell& cell : result.cells) {
    json["cells"].push_back({{"ring", cell.ring},
                             {"clock_deg", cell.clock_deg},
                             {"inward_m", number_or_null(cell.inward_m)},
                             {"std_m", number_or_null(cell.std_m)},
                             {"points", cell.points}});
  }
  for (const ConvergenceLine& line : result.lines) {
    json["lines"].push_back({{"ring", line.ring},
                             {"name", line.name},
                             {"change_m", number_or_null(line.change_m)},
                             {"std_m", number_or_null(line.std_m)}});
  }
  for (const RingFinding& finding : result.findings) {
    json["findings"].push_back({{"ring", finding.ring},
                                {"clock_deg", finding.clock_deg},
                                {"inward_m", number_or_null(finding.inward_m)},
                                {"std_m", number_or_null(finding.std_m)},
                                {"level", name_of(finding.level)},
                                {"position_m", point(finding.p_map)}});
  }
  return json;
}

LiningResult lining_from_json(const std::string& place, const Json& json) {
  const JsonObject object(place, json,
                          {"stamp_ns", "station", "pose", "registered", "registration_rms_m",
                           "registration_inlier_ratio", "correction_m", "cells", "lines", "findings"});
  LiningResult result;
  result.stamp = stamp_of(object);
  result.station = object.string("station");
  result.T_map_body = pose_from_json(place + ".pose", object.member("pose"));
  result.is_registered = object.boolean("registered");
  result.registration_rms_m = read_non_negative(object, "registration_rms_m");
  result.registration_inlier_ratio = read_non_negative(object, "registration_inlier_ratio");
  result.correction_m = read_non_negative(object, "correction_m");
  result.cells = entries<LiningCell>(object, "cells", place, {"ring", "clock_deg", "inward_m", "std_m", "points"},
                                     [](const JsonObject& cell) {
                                       return LiningCell{.ring = ring_of(cell),
                                                         .clock_deg = clock_of(cell),
                                                         .inward_m = read_number(cell, "inward_m"),
                                                         .std_m = read_non_negative(cell, "std_m"),
                                                         .points = count_of(cell, "points")};
                                     });
  result.lines = entries<ConvergenceLine>(object, "lines", place, {"ring", "name", "change_m", "std_m"},
                                          [](const JsonObject& line) {
                                            return ConvergenceLine{.ring = ring_of(line),
                                                                   .name = line.string("name"),
                                                                   .change_m = read_number(line, "change_m"),
                                                                   .std_m = read_non_negative(line, "std_m")};
                                          });
  result.findings =
      entries<RingFinding>(object, "findings", place, {"ring", "clock_deg", "inward_m", "std_m", "level", "position_m"},
                           [](const JsonObject& finding) {
                             return RingFinding{.ring = ring_of(finding),
                                                .clock_deg = clock_of(finding),
                                                .inward_m = read_number(finding, "inward_m"),
                                                .std_m = read_non_negative(finding, "std_m"),
                                                .level = level_of(finding),
                                                .p_map = point_of(finding, "position_m")};
                           });
  return result;
}

Json to_json(const WaterResult& result) {
  Json json = {{"stamp_ns", result.stamp.count()},
               {"station", result.station},
               {"pose", to_json(result.T_map_body)},
               {"soundings", result.soundings},
               {"antenna_error_deg", number_or_null(result.antenna_error_deg)},
               {"rock_spm", number_or_null(result.rock_spm)},
               {"evidence", number_or_null(result.evidence)},
               {"found", result.is_found},
               {"level", name_of(result.level)}};
  if (result.is_found) add_body(json, result);
  return json;
}

WaterResult water_from_json(const std::string& place, const Json& json) {
  std::vector<std::string> keys = {"stamp_ns", "station",  "pose",  "soundings", "antenna_error_deg",
                                   "rock_spm", "evidence", "found", "level"};
  WaterResult result;
  result.is_found = json.is_object() && json.contains("found") && json["found"] == true;
  if (result.is_found) {
    keys.insert(keys.end(), {"position_m", "covariance_m2", "distance_m", "distance_interval_m", "azimuth_deg",
                             "elevation_deg", "radius_m", "radius_interval_m"});
  }
  const JsonObject object(place, json, keys);
  result.stamp = stamp_of(object);
  result.station = object.string("station");
  result.T_map_body = pose_from_json(place + ".pose", object.member("pose"));
  result.soundings = count_of(object, "soundings");
  result.antenna_error_deg = read_non_negative(object, "antenna_error_deg");
  result.rock_spm = read_non_negative(object, "rock_spm");
  result.evidence = read_number(object, "evidence");
  result.is_found = object.boolean("found");
  result.level = level_of(object);
  if (result.is_found) read_body(object, result);
  return result;
}

}  // namespace patrol::io
