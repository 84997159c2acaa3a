#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace patrol::monitor {

/// Name and version of the schema (result.schema.json).
inline constexpr const char* kResultSchema = "patrol-result/2";

/// Result reported by a robot: envelope and data.
struct Result {
  std::string id;  ///< unique among all robots and runs
  std::string robot;
  std::string run;
  std::string world;
  std::int64_t sequence = 0;    ///< number in the run, from 0
  double time_s = 0.0;          ///< simulated time since the start of the run
  std::int64_t created_ms = 0;  ///< creation time by the robot's clock, ms since 1970, UTC
  std::string kind;             ///< pose, map, event, lining, water or status
  std::string data;             ///< JSON object of that kind, keys in fixed order
};

/// Converts a result to one line of JSON.
std::string to_json(const Result& result);

/// Parses a JSON object or a list of objects and checks each against the published schema. Throws InputError with
/// result, field and rule in one line.
std::vector<Result> results_from_json(const std::string& text);

/// Content of a result for comparison: all fields except the id.
std::string to_content(const Result& result);

/// Data for a table row. In long data, lists are replaced by their lengths and the picture is omitted.
std::string to_summary(const Result& result);

/// Formats milliseconds since 1970 as "2026-11-22T10:45:33.120Z" (RFC 3339). `from_utc` is the inverse and throws
/// InputError for any other text.
std::string to_utc(std::int64_t milliseconds);
std::int64_t from_utc(const std::string& text);

/// Current time of the computer's clock, ms since 1970, UTC.
std::int64_t now_ms();

}  // namespace patrol::monitor
