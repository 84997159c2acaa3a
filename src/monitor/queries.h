#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "monitor/database.h"

/// What the page asks for, as JSON. Names of robots, runs and stations come as they were sent: the page sets them as text.
namespace patrol::monitor {

/// What is new since a revision: {"revision", "now_ms", "robots": [...], "findings": [...]}. Since 0: all robots, the
/// newest alarms, and those that are open.
std::string changes(Database& database, std::int64_t since, std::int64_t now_ms);

/// {"robots": [...]}: where each was last, and in which run.
std::string robots(Database& database);

struct AlarmsPage {
  bool only_open = false;
  std::int64_t before = 0;  ///< those with lower numbers; 0: from the newest
  int limit = 100;
};
/// {"findings": [...]}: warnings and alarms, the newest first.
std::string alarms(Database& database, const AlarmsPage& page);

/// A run as the map shows it: {"run", "state", "stations", "track", "map", "findings"}. Without a name, the robot's newest run.
std::optional<std::string> run_details(Database& database, const std::string& robot, const std::string& run);

/// {"scans": [...], "lines": [...], "rings": [...]}: the newest scan of each station of a world, the newest change of each line and the
/// one before it, and where each ring has moved most, the newest 40 scans of it.
std::string lining(Database& database, const std::string& world);

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
