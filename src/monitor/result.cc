#include "monitor/result.h"

#include <algorithm>
#include <chrono>
#include <set>

#include <fmt/chrono.h>
#include <fmt/format.h>

#include "core/error.h"
#include "core/text.h"
#include "io/files/base64.h"
#include "io/json/inspection_json.h"
#include "io/json/json_check.h"
#include "io/json/json_object.h"
#include "monitor/png_size.h"

namespace patrol::monitor {
namespace {

using io::Json;
using io::JsonObject;

constexpr std::size_t kMaxEntries = 100'000;
constexpr std::size_t kMaxResults = 1000;  // per request
constexpr std::size_t kMaxNameBytes = 200;
constexpr std::size_t kMaxTextBytes = 2000;
constexpr std::size_t kMaxSummaryBytes = 400;
constexpr int kMaxMapSide_px = 8192;  // per side of a map

std::string text_of(const JsonObject& object, const char* key, std::size_t min_bytes, std::size_t max_bytes) {
  std::string text = object.string(key);
  if (text.size() < min_bytes || text.size() > max_bytes)
    object.fail(fmt::format("{} must have {} to {} bytes", key, min_bytes, max_bytes));
  return text;
}

std::string name_of(const JsonObject& object, const char* key) { return text_of(object, key, 1, kMaxNameBytes); }

void check_point(const JsonObject& object, const char* key) { object.numbers(key, 2); }

void check_map(const std::string& location, const Json& data) {
  const JsonObject object(location, data, {"width", "height", "resolution_m", "origin_m", "png_base64"});
  for (const char* side : {"width", "height"}) {
    if (object.integer(side) < 1 || object.integer(side) > kMaxMapSide_px)
      object.fail(fmt::format("{} must be in [1, {}]", side, kMaxMapSide_px));
  }
  if (object.number("resolution_m") <= 0.0) object.fail("resolution_m must be positive");
  check_point(object, "origin_m");
  const auto bytes = io::from_base64(object.string("png_base64"));
  const auto size = bytes ? png_size(*bytes) : std::nullopt;
  if (!size) object.fail("png_base64 must be a PNG in base64");
  if (size->width != object.integer("width") || size->height != object.integer("height")) {
    object.fail(fmt::format("png_base64 must have {} x {} pixels, it has {} x {}", object.integer("width"),
                            object.integer("height"), size->width, size->height));
  }
}

void check_event(const std::string& location, const Json& data) {
  const JsonObject object(location, data, {"kind", "subject", "text", "value", "pose", "position_m"});
  name_of(object, "kind");
  text_of(object, "subject", 0, kMaxNameBytes);
  text_of(object, "text", 0, kMaxTextBytes);
  if (!object.member("value").is_null()) object.number("value");
  io::pose_from_json(location + ".pose", object.member("pose"));
  check_point(object, "position_m");
}

void check_status(const std::string& location, const Json& data) {
  const JsonObject object(location, data, {"state", "scenario", "message", "stations"});
  const std::string state = object.string("state");
  if (state != "started" && state != "finished" && state != "failed" && state != "interrupted") {
    object.fail("state must be one of started, finished, failed, interrupted");
  }
  text_of(object, "scenario", 0, kMaxNameBytes);
  text_of(object, "message", 0, kMaxTextBytes);
  std::size_t index = 0;
  for (const Json& station : object.list("stations")) {
    const JsonObject one(fmt::format("{}.stations[{}]", location, index++), station, {"name", "type", "position_m"});
    text_of(one, "name", 0, kMaxNameBytes);
    text_of(one, "type", 0, kMaxNameBytes);
    check_point(one, "position_m");
  }
}

void check_length(const std::string& location, const std::string& text) {
  if (text.size() > kMaxTextBytes)
    throw InputError(fmt::format("{} must have at most {} bytes", location, kMaxTextBytes));
}

void check_lining(const std::string& location, const Json& data) {
  const LiningResult lining = io::lining_from_json(location, data);
  check_length(location + ".station", lining.station);
  for (const ConvergenceLine& line : lining.lines) check_length(location + ".lines.name", line.name);
}

void check_data(const std::string& location, const std::string& kind, const Json& data) {
  if (kind == "pose") io::pose_from_json(location, data);
  else if (kind == "map") check_map(location, data);
  else if (kind == "event") check_event(location, data);
  else if (kind == "lining") check_lining(location, data);
  else if (kind == "water") check_length(location + ".station", io::water_from_json(location, data).station);
  else if (kind == "status") check_status(location, data);
}

Result parse_result(const std::string& location, const Json& json) {
  const JsonObject object(location, json,
                          {"schema", "id", "robot", "run", "world", "sequence", "time_s", "made_utc", "kind", "data"});
  if (object.string("schema") != kResultSchema) object.fail(fmt::format("schema must be {}", kResultSchema));
  Result result{.id = name_of(object, "id"),
                .robot = name_of(object, "robot"),
                .run = name_of(object, "run"),
                .world = name_of(object, "world"),
                .kind = object.string("kind"),
                .data = {}};
  result.sequence = object.integer("sequence");
  if (result.sequence < 0) object.fail("sequence must not be negative");
  result.time_s = object.number("time_s");
  if (result.time_s < 0.0) object.fail("time_s must not be negative");
  try {
    result.created_ms = from_utc(object.string("made_utc"));
  } catch (const InputError& error) {
    object.fail(fmt::format("made_utc {}", error.what()));
  }
  static const std::set<std::string> kKinds = {"pose", "map", "event", "lining", "water", "status"};
  if (!kKinds.contains(result.kind)) object.fail(fmt::format("kind must be one of {}", join(kKinds, ", ")));
  const Json& data = object.member("data");
  check_data(location + ".data", result.kind, data);
  result.data = data.dump();
  return result;
}

}  // namespace

std::string to_json(const Result& result) {
  const Json json = {{"schema", kResultSchema}, {"id", result.id},
                     {"robot", result.robot},   {"run", result.run},
                     {"world", result.world},   {"sequence", result.sequence},
                     {"time_s", result.time_s}, {"made_utc", to_utc(result.created_ms)},
                     {"kind", result.kind},     {"data", Json::parse(result.data)}};
  return json.dump(-1, ' ', false, Json::error_handler_t::replace);
}

std::vector<Result> results_from_json(const std::string& text) {
  io::check_json("body", text, kMaxEntries);
  const Json json = Json::parse(text);
  if (!json.is_array()) return {parse_result("result", json)};
  if (json.size() > kMaxResults) throw InputError(fmt::format("body: must have at most {} results", kMaxResults));
  std::vector<Result> results;
  for (const Json& entry : json) results.push_back(parse_result(fmt::format("result[{}]", results.size()), entry));
  return results;
}

std::string to_content(const Result& result) {
  return Json({result.robot, result.run, result.world, result.sequence, result.time_s, result.created_ms, result.kind,
               result.data})
      .dump();
}

std::string to_summary(const Result& result) {
  if (result.data.size() <= kMaxSummaryBytes || result.kind == "event") return result.data;
  Json json = Json::parse(result.data);
  for (const auto& [key, value] : json.items()) {
    if (value.is_array()) value = value.size();
    if (key == "png_base64") value = "";
  }
  return json.dump();
}

std::string to_utc(std::int64_t milliseconds) {
  const std::chrono::sys_seconds seconds{
      std::chrono::floor<std::chrono::seconds>(std::chrono::milliseconds(milliseconds))};
  return fmt::format("{:%Y-%m-%dT%H:%M:%S}.{:03}Z", fmt::gmtime(seconds.time_since_epoch().count()),
                     ((milliseconds % 1000) + 1000) % 1000);
}

std::int64_t from_utc(const std::string& text) {
  constexpr std::string_view kForm = "0000-00-00T00:00:00.000Z";
  const auto refuse = [] { return InputError("must be a time such as 2026-11-22T10:45:33.120Z"); };
  const auto matches = [](char form, char c) { return form == '0' ? c >= '0' && c <= '9' : c == form; };
  if (!std::equal(kForm.begin(), kForm.end(), text.begin(), text.end(), matches)) throw refuse();
  const auto number = [&](std::size_t at, std::size_t length) { return std::stoi(text.substr(at, length)); };
  const int year = number(0, 4), month = number(5, 2), day = number(8, 2), hour = number(11, 2), minute = number(14, 2),
            second = number(17, 2);
  const std::chrono::year_month_day date{std::chrono::year(year), std::chrono::month(static_cast<unsigned>(month)),
                                         std::chrono::day(static_cast<unsigned>(day))};
  if (!date.ok() || year < 1970 || hour >= 24 || minute >= 60 || second >= 60) throw refuse();
  const auto time = std::chrono::sys_days(date).time_since_epoch() + std::chrono::hours(hour) +
                    std::chrono::minutes(minute) + std::chrono::seconds(second);
  return std::chrono::milliseconds(time).count() + number(20, 3);
}

std::int64_t now_ms() {
  return std::chrono::duration_cast<std::chrono::milliseconds>(std::chrono::system_clock::now().time_since_epoch())
      .count();
}

}  // namespace patrol::monitor
