#pragma once

#include "monitor/database.h"
#include "monitor/result.h"

namespace patrol::monitor {

/// Database record of a stored result.
struct RecordInfo {
  std::int64_t seq = 0;          ///< row in `results`
  std::int64_t received_ms = 0;  ///< time of reception, ms since 1970, UTC
  std::int64_t revision = 0;     ///< revision of the transaction that stored it
};

/// Tables for the page, which keep its queries fast for any number of results: robots, runs, poses, findings, gas,
/// rings, lines, and the newest scan and sounding of each station. They can be rebuilt from `results`.
extern const char* const kViews;

/// Maximum lead of a robot's clock over the server's. For later stamps the tables use the time of reception; the stored
/// result remains as received.
inline constexpr std::int64_t kClockTolerance_ms = 60'000;

/// Adds a new result to the tables.
void update_views(Database& database, const Result& result, const RecordInfo& filed);

}  // namespace patrol::monitor
