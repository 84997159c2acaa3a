#pragma once

#include "monitor/database.h"
#include "monitor/result.h"

namespace patrol::monitor {

/// Where a result stands in the store.
struct Filed {
  std::int64_t seq = 0;          ///< of its row in `results`
  std::int64_t received_ms = 0;
  std::int64_t revision = 0;     ///< of the transaction that stored it
};

/// The tables that the page reads, so that no question of its takes longer with more results: robots, runs, poses, findings, gas, rings,
/// lines, and the newest scan and sounding of each station. They can be made again from `results`.
extern const char* const kViews;

/// Largest lead of a robot's clock over the platform's. A result whose stamp is later counts in the tables as made when it was received;
/// the result itself is kept as it was sent.
inline constexpr std::int64_t kClockTolerance_ms = 60'000;

/// Enters a new result there.
void update_views(Database& database, const Result& result, const Filed& filed);

}  // namespace patrol::monitor
