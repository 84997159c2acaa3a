#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "monitor/database.h"

/// What the page asks for, as JSON. Names of robots, runs and stations come as they were sent: the page sets them as text.
namespace patrol::monitor {

/// Changes since a revision: {"revision", "now_ms", "open", "robots": [...], "more_robots": bool, "findings": [...]}. Since 0: robots, the
/// newest alarms, and those that are open. At most 200 robots: with `more_robots`, `robots` has them all, in pages.
std::string changes(Database& database, std::int64_t since, std::int64_t now_ms);

struct RobotsPage {
  std::string after;  ///< robots whose names follow this one; empty: from the first
  int limit = 200;
};
/// {"robots": [...], "more": bool}: where each was last, and in which run; by name.
std::string robots(Database& database, const RobotsPage& page = {});

struct AlarmsPage {
  bool only_open = false;
  std::int64_t before = 0;  ///< those with lower numbers; 0: from the newest
  int limit = 100;
};
/// {"findings": [...]}: warnings and alarms, the newest first.
std::string alarms(Database& database, const AlarmsPage& page);

/// A run as the map shows it: {"run", "state", "stations", "next_station", "track", "map", "findings"}. Without a name, the robot's newest
/// run. At most 500 stations, those from number `station` on; `next_station` is the number for the next page, or null.
std::optional<std::string> run_details(Database& database, const std::string& robot, const std::string& run, std::int64_t station = 0);

/// Position in the three lists of a site's lining.
struct LiningPage {
  std::int64_t scan = 0;  ///< number of the scan, from the newest
  std::int64_t cell = 0;  ///< in that scan
  std::int64_t line = 0;
  std::int64_t ring = 0;  ///< number of the ring among those that were scanned

  std::string text() const;
};
/// From "scan.cell.line.ring"; an empty text is the first page. Throws InputError when it is anything else.
LiningPage lining_page_from(const std::string& text);

/// {"scans": [...], "lines": [...], "rings": [...], "next": text or null}: the newest scan of each station of a world, the newest change of
/// each line and the one before it, and where each ring has moved most, the newest 40 scans of it. One page has at most 4,000 cells, 400
/// lines and 100 rings; a scan that does not fit goes on in the next page, with the same `seq`. Of a scan's lists other than `cells` the
/// length is given when the scan is long (result.h).
std::string lining(Database& database, const std::string& world, const LiningPage& page = {});

/// {"water": [...]}: the newest of each station; {"gas": [...]}: the newest 2,000 measurements.
std::string water(Database& database, const std::string& world);
std::string gas(Database& database, const std::string& world);

struct HistoryPage {
  std::string robot;        ///< empty: all
  std::string kind;         ///< empty: all but poses and maps
  std::int64_t before = 0;  ///< results with lower numbers; 0: from the newest
  int limit = 25;
};
/// {"results": [...], "more": bool}. Of their contents there is the summary (result.h).
std::string history(Database& database, const HistoryPage& page);

/// A map's PNG.
std::optional<std::string> map_image(Database& database, std::int64_t seq);

}  // namespace patrol::monitor
