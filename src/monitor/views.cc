#include "monitor/views.h"

#include <cmath>
#include <map>

#include <fmt/format.h>

#include "core/event.h"
#include "io/json/inspection_json.h"
#include "io/json/json_object.h"

namespace patrol::monitor {

const char* const kViews = R"sql(
CREATE TABLE IF NOT EXISTS runs (
  number INTEGER PRIMARY KEY, robot TEXT NOT NULL, run TEXT NOT NULL, world TEXT NOT NULL, scenario TEXT NOT NULL DEFAULT '', state TEXT NOT NULL DEFAULT 'started',
  message TEXT NOT NULL DEFAULT '', stations TEXT NOT NULL DEFAULT '[]', first_ms INTEGER NOT NULL, last_ms INTEGER NOT NULL, poses INTEGER NOT NULL DEFAULT 0,
  map_seq INTEGER, map_time_s REAL, UNIQUE (robot, run)) STRICT;
CREATE INDEX IF NOT EXISTS runs_of_robot ON runs (robot, first_ms);
CREATE TABLE IF NOT EXISTS robots (
  robot TEXT PRIMARY KEY, run INTEGER NOT NULL, made_ms INTEGER NOT NULL, received_ms INTEGER NOT NULL, time_s REAL NOT NULL, x REAL, y REAL, yaw REAL,
  at TEXT NOT NULL DEFAULT '', mark_revision INTEGER NOT NULL DEFAULT 0, revision INTEGER NOT NULL) STRICT;
CREATE INDEX IF NOT EXISTS robots_by_revision ON robots (revision);
CREATE TABLE IF NOT EXISTS poses (run INTEGER NOT NULL, place INTEGER NOT NULL, x REAL NOT NULL, y REAL NOT NULL, PRIMARY KEY (run, place)) STRICT, WITHOUT ROWID;
CREATE TABLE IF NOT EXISTS findings (
  number INTEGER PRIMARY KEY AUTOINCREMENT, run INTEGER NOT NULL, time_s REAL NOT NULL, made_ms INTEGER NOT NULL, received_ms INTEGER NOT NULL, level INTEGER NOT NULL,
  kind TEXT NOT NULL, subject TEXT NOT NULL, text TEXT NOT NULL, x REAL NOT NULL, y REAL NOT NULL, acknowledged_ms INTEGER, who TEXT NOT NULL DEFAULT '',
  note TEXT NOT NULL DEFAULT '', revision INTEGER NOT NULL) STRICT;
CREATE INDEX IF NOT EXISTS findings_by_revision ON findings (revision);
CREATE INDEX IF NOT EXISTS findings_of_run ON findings (run, number);
CREATE INDEX IF NOT EXISTS open_findings ON findings (level, number) WHERE acknowledged_ms IS NULL;
CREATE TABLE IF NOT EXISTS gas (world TEXT NOT NULL, station TEXT NOT NULL, made_ms INTEGER NOT NULL, run INTEGER NOT NULL, column_ppm_m REAL NOT NULL,
  PRIMARY KEY (world, made_ms, run, station)) STRICT, WITHOUT ROWID;
CREATE TABLE IF NOT EXISTS rings (world TEXT NOT NULL, ring INTEGER NOT NULL, made_ms INTEGER NOT NULL, run INTEGER NOT NULL, station TEXT NOT NULL, inward_m REAL NOT NULL,
  std_m REAL, clock_deg REAL NOT NULL, PRIMARY KEY (world, ring, made_ms, run, station)) STRICT, WITHOUT ROWID;
CREATE TABLE IF NOT EXISTS lines (world TEXT NOT NULL, ring INTEGER NOT NULL, name TEXT NOT NULL, made_ms INTEGER NOT NULL, change_m REAL NOT NULL, std_m REAL, before_m REAL,
  PRIMARY KEY (world, ring, name)) STRICT, WITHOUT ROWID;
CREATE TABLE IF NOT EXISTS newest (world TEXT NOT NULL, kind TEXT NOT NULL, station TEXT NOT NULL, made_ms INTEGER NOT NULL, seq INTEGER NOT NULL,
  PRIMARY KEY (world, kind, station)) STRICT, WITHOUT ROWID;
UPDATE robots SET made_ms = received_ms WHERE made_ms > received_ms + 60000;
)sql";

namespace {

using io::Json;

/// Level of an event for the findings page. Lining and water findings come with their own results, which hold their
/// levels.
WarningLevel finding_level(EventKind kind) {
  switch (kind) {
    case EventKind::kLiningNotice:
    case EventKind::kLiningWarning:
    case EventKind::kLiningAlarm:
    case EventKind::kWaterNotice:
    case EventKind::kWaterWarning:
    case EventKind::kWaterAlarm:
      return WarningLevel::kNone;
    default:
      return level_of(kind);
  }
}

/// Time used for ordering results. A robot clock that is too far ahead must not hide all later results.
std::int64_t ordering_ms(const Result& result, const RecordInfo& filed) {
  return result.created_ms > filed.received_ms + kClockTolerance_ms ? filed.received_ms : result.created_ms;
}

/// Adds one result to the tables.
class Entry {
 public:
  Entry(Database& database, const Result& result, const RecordInfo& filed)
      : database_(database), result_(result), filed_(filed), made_ms_(ordering_ms(result, filed)) {
    open_run();
  }

  void enter() {
    const Json data = Json::parse(result_.data);
    bool is_mark = true;  // drawn on the page, other than robots and track
    if (result_.kind == "status") enter_status(data);
    else if (result_.kind == "event") enter_event(data);
    else if (result_.kind == "lining") enter_lining(io::lining_from_json("result", data));
    else if (result_.kind == "water") enter_water(io::water_from_json("result", data));
    else if (result_.kind == "map") enter_map();
    else is_mark = false;
    const bool is_newest = update_robot(is_mark);
    if (result_.kind == "pose") enter_pose(data, is_newest);
  }

 private:
  void open_run() {
    database_
        .prepared(
            "INSERT INTO runs (robot, run, world, first_ms, last_ms) VALUES (?1, ?2, ?3, ?4, ?4) "
            "ON CONFLICT (robot, run) DO UPDATE SET first_ms = min(first_ms, ?4), last_ms = max(last_ms, ?4)")
        .bind(result_.robot, result_.run, result_.world, made_ms_)
        .run();
    run_ = database_.find_integer("SELECT number FROM runs WHERE robot = ?1 AND run = ?2", result_.robot, result_.run)
               .value();
  }

  /// Updates the robot's state. Late results of an earlier run do not change it.
  bool update_robot(bool is_mark) {
    database_
        .prepared(
            "INSERT INTO robots (robot, run, made_ms, received_ms, time_s, revision) VALUES (?1, ?2, ?3, ?4, ?5, ?6) "
            "ON CONFLICT (robot) DO NOTHING")
        .bind(result_.robot, run_, made_ms_, filed_.received_ms, result_.time_s, filed_.revision)
        .run();
    if (is_mark)
      database_.prepared("UPDATE robots SET mark_revision = ?2, revision = ?2 WHERE robot = ?1")
          .bind(result_.robot, filed_.revision)
          .run();
    database_
        .prepared(
            "UPDATE robots SET x = NULL, y = NULL, yaw = NULL, at = '', run = ?2 WHERE robot = ?1 AND run != ?2 AND "
            "made_ms <= ?3")
        .bind(result_.robot, run_, made_ms_)
        .run();
    database_
        .prepared(
            "UPDATE robots SET made_ms = ?2, received_ms = ?3, time_s = ?4, revision = ?5 WHERE robot = ?1 AND run = "
            "?6 AND made_ms <= ?2")
        .bind(result_.robot, made_ms_, filed_.received_ms, result_.time_s, filed_.revision, run_)
        .run();
    return database_.changes() > 0;
  }

  void enter_status(const Json& data) {
    const std::string state = data.at("state"), scenario = data.at("scenario"), message = data.at("message");
    // A late start message does not reopen a finished run.
    database_
        .prepared(
            "UPDATE runs SET scenario = ?2, state = CASE WHEN ?3 = 'started' THEN state ELSE ?3 END, "
            "message = CASE WHEN ?3 = 'started' THEN message ELSE ?4 END, "
            "stations = CASE WHEN ?3 = 'started' THEN ?5 ELSE stations END WHERE number = ?1")
        .bind(run_, scenario, state, message, data.at("stations").dump())
        .run();
  }

  void enter_pose(const Json& data, bool is_newest) {
    const double x = data.at("x"), y = data.at("y"), yaw = data.at("yaw");
    database_.prepared("UPDATE runs SET poses = poses + 1 WHERE number = ?1").bind(run_).run();
    database_.prepared("INSERT INTO poses SELECT ?1, poses - 1, ?2, ?3 FROM runs WHERE number = ?1")
        .bind(run_, x, y)
        .run();
    if (is_newest)
      database_.prepared("UPDATE robots SET x = ?2, y = ?3, yaw = ?4 WHERE robot = ?1")
          .bind(result_.robot, x, y, yaw)
          .run();
  }

  void enter_map() {
    database_
        .prepared(
            "UPDATE runs SET map_seq = ?2, map_time_s = ?3 WHERE number = ?1 AND (map_time_s IS NULL OR map_time_s <= "
            "?3)")
        .bind(run_, filed_.seq, result_.time_s)
        .run();
  }

  void enter_event(const Json& data) {
    const std::string kind_name = data.at("kind"), subject = data.at("subject");
    const EventKind kind = event_kind_named(kind_name);
    const Eigen::Vector2d p_map(data.at("position_m").at(0).get<double>(), data.at("position_m").at(1).get<double>());
    add_finding(finding_level(kind), kind_name, subject, data.at("text"), p_map);
    if (kind == EventKind::kGasMeasured && data.at("value").is_number()) {
      database_.prepared("INSERT OR REPLACE INTO gas VALUES (?1, ?2, ?3, ?4, ?5)")
          .bind(result_.world, subject, made_ms_, run_, data.at("value").get<double>())
          .run();
    }
    if (kind == EventKind::kGoalSaved) {
      database_
          .prepared(
              "UPDATE runs SET stations = json_insert(stations, '$[#]', "
              "json_object('name', ?2, 'type', 'marked', 'position_m', json_array(?3, ?4))) WHERE number = ?1")
          .bind(run_, subject, p_map.x(), p_map.y())
          .run();
    }
    if (kind == EventKind::kStationReached || kind == EventKind::kGoalReached || kind == EventKind::kDocked) {
      database_.prepared("UPDATE robots SET at = ?2 WHERE robot = ?1 AND run = ?3")
          .bind(result_.robot, kind == EventKind::kDocked ? std::string("dock") : subject, run_)
          .run();
    }
  }

  void enter_lining(const LiningResult& lining) {
    if (!lining.is_registered) return;
    enter_newest(lining.station);
    std::map<int, LiningCell> max_cells;  // cell with the maximum inward displacement of each ring
    for (const LiningCell& cell : lining.cells) {
      if (!std::isfinite(cell.inward_m)) continue;
      const auto [there, is_new] = max_cells.try_emplace(cell.ring, cell);
      if (!is_new && cell.inward_m > there->second.inward_m) there->second = cell;
    }
    for (const auto& [ring, cell] : max_cells) {
      database_.prepared("INSERT OR REPLACE INTO rings VALUES (?1, ?2, ?3, ?4, ?5, ?6, ?7, ?8)")
          .bind(result_.world, ring, made_ms_, run_, lining.station, cell.inward_m, cell.std_m, cell.clock_deg)
          .run();
    }
    for (const ConvergenceLine& line : lining.lines) {
      if (!std::isfinite(line.change_m)) continue;
      database_
          .prepared(
              "INSERT INTO lines VALUES (?1, ?2, ?3, ?4, ?5, ?6, NULL) "
              "ON CONFLICT DO UPDATE SET before_m = change_m, made_ms = ?4, change_m = ?5, std_m = ?6 WHERE made_ms <= "
              "?4")
          .bind(result_.world, line.ring, line.name, made_ms_, line.change_m, line.std_m)
          .run();
    }
    for (const RingFinding& finding : lining.findings) {
      const std::string text =
          fmt::format("Ring {} moved {:.1f} mm inward (standard deviation {:.1f} mm) at {:.0f} degrees.", finding.ring,
                      1e3 * finding.inward_m, 1e3 * finding.std_m, finding.clock_deg);
      add_finding(finding.level, "lining", fmt::format("ring {}", finding.ring), text, finding.p_map.head<2>());
    }
  }

  void enter_water(const WaterResult& water) {
    enter_newest(water.station);
    if (!water.is_found) return;
    const std::string text = fmt::format(
        "Water ahead: {:.1f} m from the antenna ({:.1f} ... {:.1f} m), {:.0f} degrees to the {}, {:.0f} {}.",
        water.distance_m, water.distance_low_m, water.distance_high_m, std::abs(water.azimuth_deg),
        water.azimuth_deg >= 0.0 ? "left" : "right", std::abs(water.elevation_deg),
        water.elevation_deg >= 0.0 ? "up" : "down");
    add_finding(water.level, "water", water.station, text, water.p_map.head<2>());
  }

  void enter_newest(const std::string& station) {
    database_
        .prepared(
            "INSERT INTO newest VALUES (?1, ?2, ?3, ?4, ?5) ON CONFLICT DO UPDATE SET made_ms = ?4, seq = ?5 WHERE "
            "made_ms <= ?4")
        .bind(result_.world, result_.kind, station, made_ms_, filed_.seq)
        .run();
  }

  void add_finding(WarningLevel level, const std::string& kind, const std::string& subject, const std::string& text,
                   const Eigen::Vector2d& p_map) {
    if (level == WarningLevel::kNone) return;
    database_
        .prepared(
            "INSERT INTO findings (run, time_s, made_ms, received_ms, level, kind, subject, text, x, y, revision) "
            "VALUES (?1, ?2, ?3, ?4, ?5, ?6, ?7, ?8, ?9, ?10, ?11)")
        .bind(run_, result_.time_s, result_.created_ms, filed_.received_ms, static_cast<int>(level), kind, subject,
              text, p_map.x(), p_map.y(), filed_.revision)
        .run();
  }

  Database& database_;
  const Result& result_;
  const RecordInfo& filed_;
  std::int64_t made_ms_;  ///< time used for ordering
  std::int64_t run_ = 0;
};

}  // namespace

void update_views(Database& database, const Result& result, const RecordInfo& filed) {
  Entry(database, result, filed).enter();
}

}  // namespace patrol::monitor
