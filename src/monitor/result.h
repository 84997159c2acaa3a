#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace patrol::monitor {

/// The name of the schema (result.schema.json), and its version.
inline constexpr const char* kResultSchema = "patrol-result/1";

/// Something that a robot has to tell: the envelope, and what is in it.
struct Result {
  std::string id;             ///< of this result alone, among all robots and runs
  std::string robot;
  std::string run;
  std::string world;
  std::int64_t sequence = 0;  ///< in the run, from 0
  double time_s = 0.0;        ///< simulated, since the run's start
  std::int64_t made_ms = 0;   ///< by the robot's own clock, since 1970, UTC
  std::string kind;           ///< pose, map, event, lining, water or status
  std::string data;           ///< JSON object of that kind, keys in order
};

/// One line of JSON.
std::string to_json(const Result& result);

/// A JSON object or a list of them, each held to the published schema. Throws InputError with the result, the field and the rule, in
/// one line.
std::vector<Result> results_from_json(const std::string& text);

/// What makes two results the same, beside their id.
std::string content_of(const Result& result);

/// Its data for a line of a table: of a long one, lists are given by their lengths, and the picture is left out.
std::string summary_of(const Result& result);

/// "2026-11-22T10:45:33.120Z" (RFC 3339), of milliseconds since 1970. Backwards: throws InputError when it is not that.
std::string to_utc(std::int64_t milliseconds);
std::int64_t from_utc(const std::string& text);

/// Now, by the computer's clock.
std::int64_t now_ms();

}  // namespace patrol::monitor
