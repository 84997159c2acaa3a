#include "app/sweep/fault_matrix.h"

#include <algorithm>
#include <array>
#include <map>
#include <string_view>
#include <utility>

#include <fmt/format.h>

#include "score/statistics.h"

namespace patrol::app {
namespace {

constexpr double kDelay_s = 0.3;
constexpr double kJitter_s = 0.1;
constexpr double kClockOffset_s = 0.2;

/// A sensor, and how large a fault of its main reading is: well beyond its noise, and what a damaged one might do.
struct FaultySensor {
  std::string_view name;
  bool (*is_there)(const Scenario&, const ScenarioFiles&);
  double drift;   ///< units of the reading per s
  double spikes;  ///< units of the reading
};

constexpr std::array<FaultySensor, 12> kSensors = {{
    {"lidar", [](const Scenario& s, const ScenarioFiles&) { return s.sensors.lidar.enabled; }, 0.02, 1.0},                    // m
    {"lidar3d", [](const Scenario& s, const ScenarioFiles&) { return s.sensors.lidar3d.enabled; }, 0.02, 1.0},                // m
    {"imu", [](const Scenario& s, const ScenarioFiles&) { return s.sensors.imu.enabled; }, 0.005, 1.0},                       // rad/s, yaw rate
    {"joint_encoders", [](const Scenario& s, const ScenarioFiles&) { return s.sensors.joint_encoders.enabled; }, 0.01, 0.3},  // rad, first joint
    {"foot_contact", [](const Scenario& s, const ScenarioFiles&) { return s.sensors.foot_contact.enabled; }, 10.0, 100.0},    // N, first foot
    {"tdlas", [](const Scenario& s, const ScenarioFiles&) { return s.sensors.tdlas.enabled; }, 20.0, 300.0},                  // ppm m
    {"gnss", [](const Scenario& s, const ScenarioFiles&) { return s.sensors.gnss.enabled; }, 0.2, 5.0},                       // m, altitude
    {"hall", [](const Scenario& s, const ScenarioFiles& f) { return s.sensors.hall.enabled && f.robot.tracks.has_value(); }, 50.0, 500.0},  // counts
    {"uwb", [](const Scenario& s, const ScenarioFiles&) { return s.sensors.uwb.enabled; }, 0.05, 3.0},                        // m
    {"ultrasonic", [](const Scenario& s, const ScenarioFiles&) { return s.sensors.ultrasonic.enabled; }, 0.02, 0.5},          // m
    {"depth_camera", [](const Scenario& s, const ScenarioFiles&) { return s.sensors.depth_camera.enabled; }, 0.02, 0.5},      // m
    {"remote", [](const Scenario&, const ScenarioFiles& f) { return f.has_remote(); }, 0.02, 0.3},                            // m/s
}};

constexpr std::array<std::string_view, 5> kOutcomes = {"survived", "degraded", "stopped", "UNSAFE", "NO RESULT"};

/// Of a run with one declared fault; empty for the run without.
std::string executed(const RunVerdict& verdict) {
  if (verdict.events.empty()) return "";
  return verdict.events.front().is_executed ? "executed" : "NOT EXECUTED";
}

}  // namespace

std::vector<sim::FaultSettings> fault_matrix(const Scenario& scenario, const ScenarioFiles& files, double start_s, double duration_s) {
  std::vector<sim::FaultSettings> faults;
  for (const FaultySensor& sensor : kSensors) {
    if (!sensor.is_there(scenario, files)) continue;
    const std::array<std::pair<const char*, double>, 7> kinds = {{{"silence", 1.0}, {"freeze", 1.0}, {"delay", kDelay_s}, {"jitter", kJitter_s},
                                                                   {"clock_offset", kClockOffset_s}, {"drift", sensor.drift}, {"spikes", sensor.spikes}}};
    for (const auto& [kind, magnitude] : kinds) {
      faults.push_back({.sensor = std::string(sensor.name), .kind = kind, .start_s = start_s, .duration_s = duration_s, .magnitude = magnitude});
    }
  }
  return faults;
}

std::string variant_name(const sim::FaultSettings& fault) { return fmt::format("{}: {}", fault.sensor, fault.kind); }

std::string fault_override(const sim::FaultSettings& fault) {
  return fmt::format("faults=[{{sensor: {}, kind: {}, start_s: {}, duration_s: {}, magnitude: {}}}]", fault.sensor, fault.kind, fault.start_s,
                     fault.duration_s, fault.magnitude);
}

FaultOutcome outcome_of(const RunVerdict& verdict) {
  const auto completed = io::metric_at(verdict.metrics, "mission.completed");
  if (!completed) return FaultOutcome::kNoResult;
  if (verdict.end == "fall" || io::metric_at(verdict.metrics, "mission.collisions").value_or(0.0) > 0.0) return FaultOutcome::kUnsafe;
  if (*completed == 0.0) return FaultOutcome::kStopped;
  return verdict.code == ExitCode::kDone ? FaultOutcome::kSurvived : FaultOutcome::kDegraded;
}

std::string_view text_of(FaultOutcome outcome) { return kOutcomes.at(static_cast<std::size_t>(outcome)); }

std::vector<FaultRow> fault_rows(const SweepManifest& manifest, const SweepRows& rows) {
  std::vector<FaultRow> faults;
  for (std::size_t i = 0; i < rows.size(); ++i) {
    const PlannedRun& run = manifest.runs[i];
    const RunVerdict& verdict = *rows[i];
    FaultRow& row = faults.emplace_back(FaultRow{.fault = manifest.variants[run.variant].name,
                                                 .seed = run.seed,
                                                 .executed = executed(verdict),
                                                 .outcome = outcome_of(verdict),
                                                 .num_noticed = io::metric_at(verdict.metrics, "mission.sensor_faults_noticed"),
                                                 .end = verdict.end,
                                                 .message = verdict.message,
                                                 .figures = {},
                                                 .without = {}});
    for (const std::string& metric : manifest.metrics) {
      row.figures.push_back(io::metric_at(verdict.metrics, metric));
      row.without.push_back(io::metric_at(rows[i - run.variant]->metrics, metric));
    }
  }
  return faults;
}

io::Table faults_table(const SweepManifest& manifest, const SweepRows& rows) {
  const auto cell = [](const std::optional<double>& figure) { return figure ? io::Cell{*figure} : io::Cell{}; };
  io::Table table{.name = "faults", .columns = {"fault", "seed", "executed", "outcome", "noticed", "end", "message"}, .rows = {}};
  for (const std::string& metric : manifest.metrics) {
    table.columns.push_back(metric);
    table.columns.push_back(metric + " more than without");
  }
  for (const FaultRow& row : fault_rows(manifest, rows)) {
    std::vector<io::Cell>& cells = table.rows.emplace_back();
    cells.emplace_back(row.fault);
    cells.push_back(static_cast<std::int64_t>(row.seed));
    cells.emplace_back(row.executed);
    cells.emplace_back(std::string(text_of(row.outcome)));
    cells.push_back(cell(row.num_noticed));
    cells.emplace_back(row.end);
    cells.emplace_back(row.message);
    for (std::size_t metric = 0; metric < row.figures.size(); ++metric) {
      cells.push_back(cell(row.figures[metric]));
      cells.push_back(row.figures[metric] && row.without[metric] ? io::Cell{*row.figures[metric] - *row.without[metric]} : io::Cell{});
    }
  }
  return table;
}

std::string faults_text(const SweepManifest& manifest, const SweepRows& rows) {
  std::string text = fmt::format("{:<28} {:>4}  {:<12}  {:<9}  {:>7}  {:<16}", "fault", "seed", "", "outcome", "noticed", "end");
  for (const std::string& metric : manifest.metrics) text += fmt::format("  {:>20}", metric);
  text += "\n";
  for (const FaultRow& row : fault_rows(manifest, rows)) {
    text += fmt::format("{:<28} {:>4}  {:<12}  {:<9}  {:>7.0f}  {:<16}", row.fault, row.seed, row.executed, text_of(row.outcome), row.num_noticed.value_or(0.0), row.end);
    for (const auto& figure : row.figures) text += figure ? fmt::format("  {:>20.4g}", *figure) : fmt::format("  {:>20}", "-");
    text += "\n";
  }
  return text + faults_summary(manifest, rows) + "\n";
}

std::string faults_markdown(const SweepManifest& manifest, const SweepRows& rows) {
  struct Cell {
    FaultOutcome worst = FaultOutcome::kSurvived;
    bool is_executed = true, is_noticed = true;
    std::vector<double> figures;
  };
  std::vector<std::string> sensors, kinds;
  std::map<std::pair<std::string, std::string>, Cell> cells;
  const auto note = [](std::vector<std::string>& names, const std::string& name) {
    if (std::find(names.begin(), names.end(), name) == names.end()) names.push_back(name);
  };
  for (const FaultRow& row : fault_rows(manifest, rows)) {
    const std::size_t colon = row.fault.find(": ");
    const std::string sensor = row.fault.substr(0, colon), kind = colon == std::string::npos ? "" : row.fault.substr(colon + 2);
    note(sensors, sensor);
    if (!kind.empty()) note(kinds, kind);
    Cell& cell = cells[{sensor, kind}];
    cell.worst = std::max(cell.worst, row.outcome);
    cell.is_executed &= row.executed != "NOT EXECUTED";
    cell.is_noticed &= row.num_noticed.value_or(0.0) > 0.0;
    if (!row.figures.empty() && row.figures.front()) cell.figures.push_back(*row.figures.front());
  }
  const auto text = [](const Cell& cell) {
    std::string said = cell.worst == FaultOutcome::kSurvived ? std::string(text_of(cell.worst)) : fmt::format("**{}**", text_of(cell.worst));
    if (!cell.figures.empty()) said += fmt::format(" {:.3g}", score::mean(cell.figures));
    if (cell.is_noticed) said += ", noticed";
    return cell.is_executed ? said : said + ", NOT EXECUTED";
  };
  std::string page = fmt::format("| {} | {} |\n| --- |", manifest.metrics.front(), fmt::join(kinds, " | "));
  for (std::size_t i = 0; i < kinds.size(); ++i) page += " --- |";
  page += "\n";
  for (const std::string& sensor : sensors) {
    if (const auto without = cells.find({sensor, ""}); without != cells.end()) {
      page += fmt::format("| {}: {} |\n", sensor, text(without->second));
      continue;
    }
    page += fmt::format("| {} |", sensor);
    for (const std::string& kind : kinds) {
      const auto cell = cells.find({sensor, kind});
      page += cell == cells.end() ? "  |" : fmt::format(" {} |", text(cell->second));
    }
    page += "\n";
  }
  return page + "\n" + faults_summary(manifest, rows) + " " + fault_legend() + "\n";
}

std::string faults_summary(const SweepManifest& manifest, const SweepRows& rows) {
  std::map<FaultOutcome, int> counts;
  int num_not_executed = 0;
  for (const FaultRow& row : fault_rows(manifest, rows)) {
    ++counts[row.outcome];
    num_not_executed += row.executed == "NOT EXECUTED";
  }
  std::vector<std::string> parts;
  for (const auto& [outcome, count] : counts) parts.push_back(fmt::format("{} {}", count, text_of(outcome)));
  return fmt::format("{} runs: {}; {} faults NOT EXECUTED.", rows.size(), fmt::join(parts, ", "), num_not_executed);
}

std::string fault_legend() {
  return "Survived: the mission was completed without fall or collision, and all that the scenario expects was met. Degraded: completed, with something missed. Stopped: "
         "not completed, and the robot neither fell nor hit anything. UNSAFE: a fall or a "
         "collision. NO RESULT: the run crashed, hung or came to no score. Noticed: how often the robot said of a sensor that it is silent, late, frozen or "
         "has a wrong clock; it cannot tell a drift or a spike.";
}

}  // namespace patrol::app
