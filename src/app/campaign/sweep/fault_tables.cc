#include "app/campaign/sweep/fault_tables.h"

#include <algorithm>
#include <map>
#include <utility>

#include <fmt/format.h>

#include "core/text.h"
#include "score/statistics.h"

namespace patrol::app {
namespace {

/// Outcomes of one fault over its seeds.
struct FaultCell {
  FaultOutcome worst = FaultOutcome::kSurvived;
  bool is_not_triggered = false;  ///< in one seed or more
  bool is_without_effect = true;  ///< in all seeds
  bool is_detected = true;        ///< in all seeds
  std::vector<double> values;     ///< values of the first metric

  void add(const FaultRow& row) {
    worst = std::max(worst, row.outcome);
    is_not_triggered |= row.is_not_triggered();
    is_without_effect &= row.is_without_effect();
    is_detected &= row.num_detected.value_or(0.0) > 0.0;
    if (!row.values.empty() && row.values.front()) values.push_back(*row.values.front());
  }
};

std::string text_of(const FaultCell& cell) {
  std::string text = cell.worst == FaultOutcome::kSurvived ? std::string(text_of(cell.worst))
                                                           : fmt::format("**{}**", text_of(cell.worst));
  if (!cell.values.empty()) text += fmt::format(" {:.3g}", score::maximum(cell.values));
  if (cell.is_without_effect) text += ", no effect";
  if (cell.is_detected) text += ", detected";
  if (cell.is_not_triggered) text += ", not triggered";
  return text;
}

void add_once(std::vector<std::string>& names, const std::string& name) {
  if (std::find(names.begin(), names.end(), name) == names.end()) names.push_back(name);
}

/// Cells by sensor and kind of fault, both in the order of their first run.
struct FaultGrid {
  std::vector<std::string> sensors, kinds;
  std::map<std::pair<std::string, std::string>, FaultCell> cells;
  FaultCell baseline;
  std::string baseline_name;
};

FaultGrid grid_of(const std::vector<FaultRow>& rows) {
  FaultGrid grid;
  for (const FaultRow& row : rows) {
    if (row.fault.kind.empty()) {
      grid.baseline_name = row.name;
      grid.baseline.add(row);
      continue;
    }
    add_once(grid.sensors, row.fault.sensor);
    add_once(grid.kinds, row.fault.kind);
    grid.cells[{row.fault.sensor, row.fault.kind}].add(row);
  }
  return grid;
}

}  // namespace

io::Table faults_table(const SweepManifest& manifest, const SweepRows& rows) {
  const auto cell = [](const std::optional<double>& value) {
    return value ? io::TableValue{*value} : io::TableValue{};
  };
  io::Table table{.name = "faults",
                  .columns = {"fault", "seed", "triggered", "effect", "outcome", "detected", "end", "message"},
                  .rows = {}};
  for (const std::string& metric : manifest.metrics) {
    table.columns.push_back(metric);
    table.columns.push_back(metric + " difference");
  }
  for (const FaultRow& row : fault_rows(manifest, rows)) {
    std::vector<io::TableValue>& cells = table.rows.emplace_back();
    cells.emplace_back(row.name);
    cells.emplace_back(static_cast<std::int64_t>(row.seed));
    cells.emplace_back(trigger_text(row));
    cells.emplace_back(effect_text(row));
    cells.emplace_back(std::string(text_of(row.outcome)));
    cells.push_back(cell(row.num_detected));
    cells.emplace_back(row.end);
    cells.emplace_back(row.message);
    for (std::size_t metric = 0; metric < row.values.size(); ++metric) {
      cells.push_back(cell(row.values[metric]));
      cells.push_back(row.values[metric] && row.baseline_values[metric]
                          ? io::TableValue{*row.values[metric] - *row.baseline_values[metric]}
                          : io::TableValue{});
    }
  }
  return table;
}

std::string faults_text(const SweepManifest& manifest, const SweepRows& rows) {
  std::string text = fmt::format("{:<28} {:>4}  {:<13}  {:<9}  {:<9}  {:>8}  {:<16}", "fault", "seed", "", "",
                                 "outcome", "detected", "end");
  for (const std::string& metric : manifest.metrics) text += fmt::format("  {:>20}", metric);
  text += "\n";
  const std::vector<FaultRow> all = fault_rows(manifest, rows);
  for (const FaultRow& row : all) {
    text += fmt::format("{:<28} {:>4}  {:<13}  {:<9}  {:<9}  {:>8.0f}  {:<16}", row.name, row.seed, trigger_text(row),
                        effect_text(row), text_of(row.outcome), row.num_detected.value_or(0.0), row.end);
    for (const auto& value : row.values)
      text += value ? fmt::format("  {:>20.4g}", *value) : fmt::format("  {:>20}", "-");
    text += "\n";
  }
  return text + faults_summary(all) + "\n";
}

std::string faults_markdown(const SweepManifest& manifest, const SweepRows& rows) {
  const std::vector<FaultRow> all = fault_rows(manifest, rows);
  const FaultGrid grid = grid_of(all);
  std::string page = fmt::format("| {} | {} |\n| --- |", manifest.metrics.front(), join(grid.kinds, " | "));
  for (std::size_t i = 0; i < grid.kinds.size(); ++i) page += " --- |";
  page += fmt::format("\n| {}: {} |\n", grid.baseline_name, text_of(grid.baseline));
  for (const std::string& sensor : grid.sensors) {
    page += fmt::format("| {} |", sensor);
    for (const std::string& kind : grid.kinds) {
      const auto cell = grid.cells.find({sensor, kind});
      page += cell == grid.cells.end() ? "  |" : fmt::format(" {} |", text_of(cell->second));
    }
    page += "\n";
  }
  return page + "\n" + faults_summary(all) + " " + fault_legend() + "\n";
}

}  // namespace patrol::app
