#include "monitor/queries.h"

#include <algorithm>
#include <charconv>

#include <fmt/format.h>

#include "core/error.h"
#include "core/inspection_result.h"
#include "io/files/base64.h"
#include "io/json/json_object.h"

namespace patrol::monitor {
namespace {

using io::Json;

constexpr int kMaxChanges = 200;
constexpr int kMaxTrackPoints = 600;
constexpr int kMaxRings = 500;
constexpr int kMaxRingRows = 40;  // per ring
constexpr int kMaxGasRows = 2'000;
constexpr int kMaxLines = 2'000;
constexpr int kMaxStations = 20;
constexpr int kMaxPageRows = 200;
constexpr int kMaxRunStations = 500;  // limits of one page, also those below
constexpr int kMaxCells = 4'000;
constexpr int kPageLines = 400;
constexpr int kPageRings = 100;

Json value_of(const Statement& row, int column) {
  switch (row.type(column)) {
    case Statement::Type::kNull:
      return nullptr;
    case Statement::Type::kInteger:
      return row.integer(column);
    case Statement::Type::kNumber:
      return row.number(column);
    case Statement::Type::kText:
      return row.text(column);
  }
  return nullptr;
}

/// JSON object of a row, keyed by column name.
Json object_of(const Statement& row) {
  Json object;
  for (int column = 0; column < row.num_columns(); ++column) object[row.name(column)] = value_of(row, column);
  return object;
}

/// JSON objects of the remaining rows.
Json objects_of(Statement& rows) {
  Json list = Json::array();
  while (rows.step()) list.push_back(object_of(rows));
  return list;
}

constexpr const char* kRobots =
    "SELECT robots.robot, runs.run, world, scenario, state, message, robots.made_ms, robots.received_ms, "
    "robots.time_s, x, y, yaw, at, "
    "mark_revision, map_seq IS NOT NULL AS has_map FROM robots JOIN runs ON runs.number = robots.run";

constexpr const char* kFindings =
    "SELECT findings.number, robot, runs.run, world, time_s, made_ms, received_ms, "
    "CASE level WHEN 1 THEN 'notice' WHEN 2 THEN 'warning' ELSE 'alarm' END AS level, kind, subject, text, x, y, "
    "acknowledged_ms, who, note "
    "FROM findings JOIN runs ON runs.number = findings.run";

/// Number of unacknowledged warnings and alarms.
Json open_count(Database& database) {
  Json count = {{"warning", 0}, {"alarm", 0}};
  Statement row = database.prepare(
      "SELECT level, count(*) FROM findings WHERE acknowledged_ms IS NULL AND level >= 2 GROUP BY level");
  while (row.step()) count[name_of(static_cast<WarningLevel>(row.integer(0)))] = row.integer(1);
  return count;
}

Json findings_page(Database& database, const AlarmsPage& page) {
  const std::string where = fmt::format(
      " WHERE findings.level >= 2 AND (?1 = 0 OR findings.number < ?1){} ORDER BY findings.number DESC LIMIT ?2",
      page.only_open ? " AND findings.acknowledged_ms IS NULL" : "");
  Statement rows = database.prepare(kFindings + where);
  return objects_of(rows.bind(page.before, std::clamp(page.limit, 1, kMaxPageRows)));
}

/// Equally spaced positions of a run, at most 600, and the last one.
Json track_of(Database& database, std::int64_t run, std::int64_t num_poses) {
  Json track = Json::array();
  const std::int64_t step = num_poses / kMaxTrackPoints + 1;
  Statement row = database.prepare("SELECT x, y FROM poses WHERE run = ?1 AND place = ?2");
  const auto add = [&](std::int64_t index) {
    if (row.bind(run, index).step()) track.push_back({row.number(0), row.number(1)});
  };
  for (std::int64_t index = 0; index < num_poses; index += step) add(index);
  if (num_poses > 0 && (num_poses - 1) % step != 0) add(num_poses - 1);
  return track;
}

Json map_geometry(Database& database, std::int64_t seq) {
  Statement row = database.prepare("SELECT json_remove(data, '$.png_base64') FROM results WHERE seq = ?1");
  if (!row.bind(seq).step()) return nullptr;
  Json map = Json::parse(row.text(0));
  map["seq"] = seq;
  return map;
}

/// Adds one page of a run's stations and the first number of the next page.
void add_stations(Json& json, Database& database, std::int64_t run, std::int64_t first) {
  Statement row = database.prepare("SELECT value FROM runs, json_each(stations) WHERE number = ?1 LIMIT ?2 OFFSET ?3");
  row.bind(run, kMaxRunStations + 1, first);
  Json list = Json::array();
  while (row.step()) list.push_back(Json::parse(row.text(0)));
  const bool has_more = list.size() > static_cast<std::size_t>(kMaxRunStations);
  if (has_more) list.erase(list.size() - 1);
  json["stations"] = std::move(list);
  json["next_station"] = has_more ? Json(first + kMaxRunStations) : Json(nullptr);
}

/// Newest result of each station with its data as stored.
std::string newest_of(Database& database, const std::string& world, const char* kind) {
  std::string list;
  Statement row = database.prepare(
      "SELECT results.robot, results.run, results.time_s, results.made_ms, results.data FROM newest JOIN results USING "
      "(seq) "
      "WHERE newest.world = ?1 AND newest.kind = ?2 ORDER BY newest.made_ms DESC LIMIT ?3");
  row.bind(world, kind, kMaxStations);
  while (row.step()) {
    std::string one =
        Json{{"robot", row.text(0)}, {"run", row.text(1)}, {"time_s", row.number(2)}, {"made_ms", row.integer(3)}}
            .dump();
    one.pop_back();
    list += fmt::format(R"({}{},"data":{}}})", list.empty() ? "" : ",", one, row.text(4));
  }
  return "[" + list + "]";
}

/// Adds one page of the cells of the newest scans. Advances `page` and returns true when another page follows.
bool add_scans(Json& scans, Database& database, const std::string& world, LiningPage& page) {
  Statement scan = database.prepare(
      "SELECT seq, results.robot, results.run, results.time_s, results.made_ms, results.summary FROM newest JOIN "
      "results USING (seq) "
      "WHERE newest.world = ?1 AND newest.kind = 'lining' ORDER BY newest.made_ms DESC, seq DESC LIMIT ?2 OFFSET ?3");
  scan.bind(world, std::max<std::int64_t>(kMaxStations - page.scan, 0), page.scan);
  Statement cell =
      database.prepare("SELECT value FROM results, json_each(data, '$.cells') WHERE seq = ?1 LIMIT ?2 OFFSET ?3");
  scans = Json::array();
  for (int num_left = kMaxCells; scan.step(); ++page.scan, page.cell = 0) {
    if (num_left == 0) return true;
    Json data = Json::parse(scan.text(5));
    Json& cells = data["cells"] = Json::array();
    for (cell.bind(scan.integer(0), num_left, page.cell); cell.step();) cells.push_back(Json::parse(cell.text(0)));
    num_left -= static_cast<int>(cells.size());
    page.cell += static_cast<std::int64_t>(cells.size());
    scans.push_back({{"seq", scan.integer(0)},
                     {"robot", scan.text(1)},
                     {"run", scan.text(2)},
                     {"time_s", scan.number(3)},
                     {"made_ms", scan.integer(4)},
                     {"data", std::move(data)}});
    if (num_left == 0) return true;
  }
  return false;
}

bool add_lines(Json& lines, Database& database, const std::string& world, LiningPage& page) {
  Statement rows = database.prepare(
      "SELECT ring, name, made_ms, change_m, std_m, before_m FROM lines WHERE world = ?1 ORDER BY ring, name LIMIT ?2 "
      "OFFSET ?3");
  const std::int64_t limit = std::clamp<std::int64_t>(kMaxLines - page.line, 0, kPageLines);
  lines = objects_of(rows.bind(world, limit, page.line));
  page.line += limit;
  return static_cast<std::int64_t>(lines.size()) == limit && page.line < kMaxLines;
}

/// Adds [ring, created_ms, inward_m, std_m, clock_deg] for the newest scans of each ring, in order of time.
bool add_rings(Json& rings, Database& database, const std::string& world, LiningPage& page) {
  Statement numbers = database.prepare(
      "WITH RECURSIVE known (ring) AS (SELECT min(ring) FROM rings WHERE world = ?1 UNION ALL "
      "SELECT (SELECT min(ring) FROM rings WHERE world = ?1 AND ring > known.ring) FROM known WHERE known.ring IS NOT "
      "NULL) "
      "SELECT ring FROM known WHERE ring IS NOT NULL LIMIT ?2 OFFSET ?3");
  Statement row = database.prepare(
      "SELECT made_ms, inward_m, std_m, clock_deg FROM rings WHERE world = ?1 AND ring = ?2 ORDER BY made_ms DESC "
      "LIMIT ?3");
  const std::int64_t limit = std::clamp<std::int64_t>(kMaxRings - page.ring, 0, kPageRings);
  rings = Json::array();
  std::int64_t count = 0;
  for (numbers.bind(world, limit, page.ring); numbers.step(); ++count) {
    const std::int64_t ring = numbers.integer(0);
    Json one = Json::array();
    row.bind(world, ring, kMaxRingRows);
    while (row.step()) one.push_back({ring, row.integer(0), row.number(1), value_of(row, 2), row.number(3)});
    std::reverse(one.begin(), one.end());
    rings.insert(rings.end(), one.begin(), one.end());
  }
  page.ring += limit;
  return count == limit && page.ring < kMaxRings;
}

}  // namespace

std::string changes(Database& database, std::int64_t since, std::int64_t now_ms) {
  Statement revision = database.prepare("SELECT number FROM revision");
  revision.step();
  Json json = {{"revision", revision.integer(0)}, {"now_ms", now_ms}, {"open", open_count(database)}};
  Statement rows =
      database.prepare(std::string(kRobots) + " WHERE robots.revision > ?1 ORDER BY robots.robot LIMIT ?2");
  json["robots"] = objects_of(rows.bind(since, kMaxChanges + 1));
  json["more_robots"] = json["robots"].size() > static_cast<std::size_t>(kMaxChanges);
  if (json["more_robots"]) json["robots"].erase(json["robots"].size() - 1);
  if (since == 0) {
    json["findings"] = findings_page(database, {.limit = kMaxPageRows});
    for (Json& open : findings_page(database, {.only_open = true, .limit = kMaxPageRows}))
      json["findings"].push_back(std::move(open));
  } else {
    Statement findings = database.prepare(
        std::string(kFindings) +
        " WHERE findings.revision > ?1 AND findings.level >= 2 ORDER BY findings.number DESC LIMIT ?2");
    json["findings"] = objects_of(findings.bind(since, kMaxChanges));
  }
  return json.dump();
}

std::string robots(Database& database, const RobotsPage& page) {
  Statement rows = database.prepare(std::string(kRobots) + " WHERE robots.robot > ?1 ORDER BY robots.robot LIMIT ?2");
  const int limit = std::clamp(page.limit, 1, kMaxPageRows);
  Json list = objects_of(rows.bind(page.after, limit + 1));
  const bool has_more = list.size() > static_cast<std::size_t>(limit);
  if (has_more) list.erase(list.size() - 1);
  return Json{{"robots", list}, {"more", has_more}}.dump();
}

std::string alarms(Database& database, const AlarmsPage& page) {
  return Json{{"findings", findings_page(database, page)}, {"open", open_count(database)}}.dump();
}

std::optional<std::string> run_details(Database& database, const std::string& robot, const std::string& run,
                                       std::int64_t station) {
  Statement row = database.prepare(
      "SELECT number, poses, map_seq, robot, run, world, scenario, state, message FROM runs "
      "WHERE robot = ?1 AND (?2 = '' OR run = ?2) ORDER BY first_ms DESC LIMIT 1");
  if (!row.bind(robot, run).step()) return std::nullopt;
  Json json = object_of(row);
  const std::int64_t number = row.integer(0);
  json["track"] = track_of(database, number, row.integer(1));
  json["map"] = row.is_null(2) ? Json(nullptr) : map_geometry(database, row.integer(2));
  add_stations(json, database, number, station);
  Statement findings =
      database.prepare(std::string(kFindings) + " WHERE findings.run = ?1 ORDER BY findings.number DESC LIMIT ?2");
  json["findings"] = objects_of(findings.bind(number, kMaxPageRows));
  Statement runs =
      database.prepare("SELECT run, first_ms, state FROM runs WHERE robot = ?1 ORDER BY first_ms DESC LIMIT 50");
  json["runs"] = objects_of(runs.bind(robot));
  return json.dump();
}

std::string LiningPage::text() const { return fmt::format("{}.{}.{}.{}", scan, cell, line, ring); }

LiningPage parse_lining_page(const std::string& text) {
  constexpr std::int64_t kMax = 1'000'000;
  LiningPage page;
  if (text.empty()) return page;
  const char* at = text.data();
  const char* const end = at + text.size();
  bool is_page = true;
  for (std::int64_t* number : {&page.scan, &page.cell, &page.line, &page.ring}) {
    const auto [next, error] = std::from_chars(at, end, *number);
    is_page = is_page && error == std::errc() && *number >= 0 && *number <= kMax;
    is_page = is_page && (number == &page.ring ? next == end : next != end && *next == '.');
    if (!is_page) throw InputError("after must be the `next` of the page before");
    at = next + 1;
  }
  return page;
}

std::string lining(Database& database, const std::string& world, const LiningPage& page) {
  LiningPage next = page;
  Json json;
  const bool has_scans = add_scans(json["scans"], database, world, next),
             has_lines = add_lines(json["lines"], database, world, next),
             has_rings = add_rings(json["rings"], database, world, next);
  json["next"] = has_scans || has_lines || has_rings ? Json(next.text()) : Json(nullptr);
  return json.dump();
}

std::string water(Database& database, const std::string& world) {
  return fmt::format(R"({{"water":{}}})", newest_of(database, world, "water"));
}

std::string gas(Database& database, const std::string& world) {
  Json list = Json::array();
  Statement row = database.prepare(
      "SELECT station, made_ms, column_ppm_m FROM gas WHERE world = ?1 ORDER BY made_ms DESC LIMIT ?2");
  row.bind(world, kMaxGasRows);
  while (row.step()) list.push_back({row.text(0), row.integer(1), row.number(2)});
  std::reverse(list.begin(), list.end());
  return Json{{"gas", list}}.dump();
}

std::string history(Database& database, const HistoryPage& page) {
  std::string sql =
      "SELECT summary AS data, seq, id, robot, run, world, time_s, made_ms, received_ms, kind FROM results WHERE (?1 = "
      "0 OR seq < ?1)";
  sql += page.robot.empty() ? " AND ?2 = ''" : " AND robot = ?2";
  sql += page.kind.empty() ? " AND ?3 = '' AND kind NOT IN ('pose', 'map')" : " AND kind = ?3";
  Statement row = database.prepare(sql + " ORDER BY seq DESC LIMIT ?4");
  const int limit = std::clamp(page.limit, 1, kMaxPageRows);
  row.bind(page.before, page.robot, page.kind, limit + 1);
  Json list = Json::array();
  while (row.step()) {
    list.push_back(object_of(row));
    list.back()["data"] = Json::parse(row.text(0));
  }
  const bool has_more = list.size() > static_cast<std::size_t>(limit);
  if (has_more) list.erase(list.size() - 1);
  return Json{{"results", list}, {"more", has_more}}.dump();
}

std::optional<std::string> map_image(Database& database, std::int64_t seq) {
  Statement row = database.prepare("SELECT data FROM results WHERE seq = ?1 AND kind = 'map'");
  if (!row.bind(seq).step()) return std::nullopt;
  return io::from_base64(Json::parse(row.text(0))["png_base64"].get<std::string>());
}

}  // namespace patrol::monitor
