#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "monitor/database.h"

/// Database queries of the page, as JSON. Names of robots, runs and stations are returned as received; the page inserts
/// them as text.
namespace patrol::monitor {

/// Changes since a revision: {"revision", "now_ms", "open", "robots": [...], "more_robots": bool, "findings": [...]}.
/// Since 0: robots, the newest alarms and the open ones. At most 200 robots; if `more_robots` is set, all are returned
/// by `robots`.
std::string changes(Database& database, std::int64_t since, std::int64_t now_ms);

/// Page of the list of robots.
struct RobotsPage {
  std::string after;  ///< robots with names greater than this one; empty: from the first
  int limit = 200;
};
/// {"robots": [...], "more": bool}: last known pose and run of each robot, ordered by name.
std::string robots(Database& database, const RobotsPage& page = {});

/// Page of the list of warnings and alarms.
struct AlarmsPage {
  bool only_open = false;
  std::int64_t before = 0;  ///< findings with lower numbers; 0: from the newest
  int limit = 100;
};
/// {"findings": [...], "open": {...}}: warnings and alarms, newest first, and the number of open ones.
std::string alarms(Database& database, const AlarmsPage& page);

/// Data of a run for the map: {"run", "state", "stations", "next_station", "track", "map", "findings", "runs"}. An
/// empty `run` selects the robot's newest run. At most 500 stations from number `station` on; `next_station` is the
/// first number of the next page, or null.
std::optional<std::string> run_details(Database& database, const std::string& robot, const std::string& run,
                                       std::int64_t station = 0);

/// Position in the three lists of a site's lining data.
struct LiningPage {
  std::int64_t scan = 0;  ///< index of the scan, from the newest
  std::int64_t cell = 0;  ///< index of the cell in that scan
  std::int64_t line = 0;
  std::int64_t ring = 0;  ///< index of the ring among the scanned rings

  /// Inverse of `parse_lining_page`.
  std::string text() const;
};
/// Parses "scan.cell.line.ring"; an empty text is the first page. Throws InputError for any other text.
LiningPage parse_lining_page(const std::string& text);

/// {"scans": [...], "lines": [...], "rings": [...], "next": text or null} of a world. `scans`: newest scan of each
/// station. `lines`: newest and previous change of each convergence line. `rings`: maximum inward displacement of each
/// ring in its newest 40 scans. A page has at most 4,000 cells, 400 lines and 100 rings. A scan that does not fit
/// continues on the next page with the same `seq`. For long scans, lists other than `cells` are given by their length
/// (to_summary in result.h).
std::string lining(Database& database, const std::string& world, const LiningPage& page = {});

/// {"water": [...]}: newest result of each station. {"gas": [...]}: newest 2,000 measurements.
std::string water(Database& database, const std::string& world);
std::string gas(Database& database, const std::string& world);

/// Page of the list of results with its filter.
struct HistoryPage {
  std::string robot;        ///< empty: all robots
  std::string kind;         ///< empty: all kinds except poses and maps
  std::int64_t before = 0;  ///< results with lower numbers; 0: from the newest
  int limit = 25;
};
/// {"results": [...], "more": bool}: results with the summary of their data (to_summary in result.h), newest first.
std::string history(Database& database, const HistoryPage& page);

/// PNG of a map, none for an unknown number.
std::optional<std::string> map_image(Database& database, std::int64_t seq);

}  // namespace patrol::monitor
