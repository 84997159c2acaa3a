#include "app/report/metric_blocks.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <utility>

#include <fmt/format.h>

#include "app/scoring/metric_lines.h"
#include "report/boxes.h"

namespace patrol::app {
namespace {

using report::Tone;

/// Cell with a metric of an entry in fixed decimals, which aligns the decimal points of a column.
report::TableCell metric_cell(const io::Metrics& entry, const std::string& path, int decimals, double factor = 1.0) {
  const std::optional<double> value = io::metric_at(entry, path);
  return value ? report::TableCell{fmt::format("{:.{}f}", factor * *value, decimals)}
               : report::TableCell{"–", Tone::kFaint};
}

report::TableCell checked_cell(const std::string& path, const std::vector<CheckedExpectation>& checks) {
  const auto check =
      std::find_if(checks.begin(), checks.end(), [&](const CheckedExpectation& one) { return one.metric == path; });
  if (check == checks.end()) return {};
  return {check->wanted + (check->is_met ? " met" : " MISSED"), check->is_met ? Tone::kGood : Tone::kBad};
}

/// Values of a metric by arrival; empty if the goal was never reached.
std::vector<double> each_of(const io::Metrics& goal, const std::string& metric) {
  std::vector<double> values;
  if (!goal.contains(metric) || !goal[metric].contains("each")) return values;
  for (const io::Metrics& value : goal[metric]["each"]) values.push_back(value.get<double>());
  return values;
}

/// Box plot with a dot for every arrival; empty if no goal was reached more than once.
report::BoxPlot box_plot(const io::Metrics& metrics, const std::string& metric, const std::string& caption) {
  const report::Unit unit = report::unit_of(metric);
  report::BoxPlot plot{.caption = caption, .unit = unit.name, .boxes = {}};
  for (const io::Metrics& goal : metrics["goals"])
    plot.boxes.push_back(report::box_of(goal.value("name", ""), each_of(goal, metric), unit));
  if (metrics.contains("docking"))
    plot.boxes.push_back(report::box_of("dock", each_of(metrics["docking"], metric), unit));
  const auto is_single = [](const report::Box& box) { return box.values.size() < 2; };
  if (std::all_of(plot.boxes.begin(), plot.boxes.end(), is_single)) plot.boxes.clear();
  return plot;
}

std::vector<report::TableCell> goal_row(const std::string& name, const io::Metrics& goal) {
  std::vector<report::TableCell> row = {{name}, metric_cell(goal, "arrivals", 0), metric_cell(goal, "failed", 0)};
  if (io::metric_at(goal, "failed").value_or(0.0) > 0.0) row.back().tone = Tone::kBad;
  for (const char* statistic : {"mean", "std", "max"})
    row.push_back(metric_cell(goal, fmt::format("position_error_m.{}", statistic), 2, 100.0));
  for (const char* statistic : {"mean", "std", "max"})
    row.push_back(metric_cell(goal, fmt::format("heading_error_deg.{}", statistic), 2));
  return row;
}

bool is_list(const io::Metrics& metrics, const char* key) {
  return metrics.contains(key) && metrics[key].is_array() && !metrics[key].empty();
}

}  // namespace

report::CollapsibleTables all_metrics(const io::Metrics& metrics, const std::vector<CheckedExpectation>& checks) {
  const std::vector<MetricLine> lines = metric_lines(metrics);
  report::CollapsibleTables collapsed{.summary = fmt::format("All {} metrics", lines.size()), .tables = {}};
  for (const MetricLine& line : lines) {
    const std::size_t dot = line.path.find('.');
    const std::string group = line.path.substr(0, dot);
    if (collapsed.tables.empty() || collapsed.tables.back().caption != group) {
      collapsed.tables.push_back({.caption = group, .columns = {{""}, {"", true}, {""}}, .rows = {}});
    }
    collapsed.tables.back().rows.push_back(
        {{dot == std::string::npos ? group : line.path.substr(dot + 1)}, {line.text}, checked_cell(line.path, checks)});
  }
  return collapsed;
}

std::vector<report::Block> station_blocks(const io::Metrics& metrics) {
  if (!is_list(metrics, "stations")) return {};
  report::TableBlock table{.caption = "",
                           .columns = {{"station"},
                                       {"reached"},
                                       {"estimated position error, cm", true},
                                       {"heading error, °", true},
                                       {"true position error, cm", true},
                                       {"map error, cm", true}},
                           .rows = {}};
  for (const io::Metrics& station : metrics["stations"]) {
    const bool is_reached = io::metric_at(station, "reached").value_or(0.0) > 0.5;
    table.rows.push_back({{station.value("name", "")},
                          is_reached ? report::TableCell{"yes", Tone::kGood} : report::TableCell{"NO", Tone::kBad},
                          metric_cell(station, "position_error_m", 1, 100.0),
                          metric_cell(station, "heading_error_deg", 2),
                          metric_cell(station, "stand_error_m", 1, 100.0),
                          metric_cell(station, "map_error_m", 1, 100.0)});
  }
  return {
      table,
      report::TextBlock{
          "On arrival: error of the estimated pose and heading; distance of the true position from the surveyed one; "
          "local displacement between map and world."}};
}

std::vector<report::Block> goal_blocks(const io::Metrics& metrics) {
  if (!is_list(metrics, "goals")) return {};
  report::TableBlock table{.caption = "",
                           .columns = {{"goal"},
                                       {"reached", true},
                                       {"failed", true},
                                       {"position, cm: mean", true},
                                       {"std", true},
                                       {"max", true},
                                       {"heading, °: mean", true},
                                       {"std", true},
                                       {"max", true}},
                           .rows = {}};
  for (const io::Metrics& goal : metrics["goals"]) table.rows.push_back(goal_row(goal.value("name", ""), goal));
  if (metrics.contains("docking")) table.rows.push_back(goal_row("dock", metrics["docking"]));
  std::vector<report::Block> blocks = {table};
  for (const auto& [metric, caption] : {std::pair("position_error_m", "Position error on arrival"),
                                        std::pair("heading_error_deg", "Heading error on arrival")}) {
    report::BoxPlot plot = box_plot(metrics, metric, caption);
    if (!plot.boxes.empty()) blocks.emplace_back(std::move(plot));
  }
  if (blocks.size() > 1)
    blocks.emplace_back(
        report::TextBlock{"Box: quartiles; line: minimum to maximum; dots: every arrival; right: median."});
  return blocks;
}

namespace {

std::vector<report::Block> leak_blocks(const io::Metrics& metrics) {
  const bool has_findings = metrics.contains("inspection") && is_list(metrics["inspection"], "findings");
  if (!has_findings && io::metric_at(metrics, "inspection.leaks").value_or(0.0) == 0.0) return {};
  if (!has_findings)
    return {report::TextBlock{
        fmt::format("{:.0f} leaks in the world, none found.", *io::metric_at(metrics, "inspection.leaks"))}};
  report::TableBlock table{.caption = "",
                           .columns = {{"finding at"},
                                       {"column, ppm m", true},
                                       {"x, m", true},
                                       {"y, m", true},
                                       {"leak"},
                                       {"position error, cm", true}},
                           .rows = {}};
  for (const io::Metrics& finding : metrics["inspection"]["findings"]) {
    const bool is_leak = finding.contains("leak") && finding["leak"].is_string();
    table.rows.push_back({{finding.value("station", "")},
                          metric_cell(finding, "column_ppm_m", 0),
                          metric_cell(finding, "x_m", 2),
                          metric_cell(finding, "y_m", 2),
                          is_leak ? report::TableCell{finding["leak"].get<std::string>(), Tone::kGood}
                                  : report::TableCell{"false alarm", Tone::kBad},
                          metric_cell(finding, "position_error_m", 1, 100.0)});
  }
  return {table};
}

std::vector<report::Block> lining_blocks(const io::Metrics& metrics) {
  if (!io::metric_at(metrics, "inspection.lining.stations")) return {};
  const io::Metrics& lining = metrics["inspection"]["lining"];
  report::TableBlock table{.caption = "Lining rings",
                           .columns = {{"station"},
                                       {"ring", true},
                                       {"true peak, mm", true},
                                       {"reported, mm", true},
                                       {"error, mm", true},
                                       {"position error, cm", true},
                                       {""}},
                           .rows = {}};
  for (const io::Metrics& ring : lining["rings"]) {
    const bool is_found = ring.value("is_found", false), has_moved = std::abs(ring.value("true_peak_mm", 0.0)) > 0.0;
    table.rows.push_back({{ring.value("station", "")},
                          {fmt::format("{}", ring.value("ring", 0))},
                          metric_cell(ring, "true_peak_mm", 1),
                          metric_cell(ring, "reported_mm", 2),
                          metric_cell(ring, "error_mm", 2),
                          metric_cell(ring, "place_error_m", 1, 100.0),
                          !is_found   ? report::TableCell{"missed", Tone::kBad}
                          : has_moved ? report::TableCell{"found", Tone::kGood}
                                      : report::TableCell{"false finding", Tone::kBad}});
  }
  const auto value = [&](const char* name) { return io::metric_at(lining, name).value_or(0.0); };
  return {table, report::TextBlock{fmt::format("{:.0f} of {:.0f} scans were registered to their references. {:.0f} "
                                               "cells (sectors of a ring): RMS error {:.2f} mm; {:.1f} % of their "
                                               "95 % intervals contain the true value.",
                                               value("registered"), value("stations"), value("cells"),
                                               value("cell_rmse_mm"), 100.0 * value("cell_coverage_95"))}};
}

std::vector<report::Block> water_blocks(const io::Metrics& metrics) {
  if (!io::metric_at(metrics, "inspection.water.stations")) return {};
  const io::Metrics& water = metrics["inspection"]["water"];
  const auto value = [&](const char* name) { return io::metric_at(water, name).value_or(0.0); };
  const std::string summary =
      fmt::format("Bodies of water ahead of the face: {:.0f}; found: {:.0f}; false alarms: {:.0f}.", value("bodies"),
                  value("found"), value("false_alarms"));
  if (!is_list(water, "findings")) return {report::TextBlock{summary}};
  report::TableBlock table{.caption = "Water ahead of the face",
                           .columns = {{"soundings"},
                                       {"position error, m", true},
                                       {"of that along the path, m", true},
                                       {"radius error, m", true},
                                       {"interval"},
                                       {""}},
                           .rows = {}};
  for (const io::Metrics& finding : water["findings"]) {
    const bool is_true = finding.value("is_true", false);
    const bool is_in_interval = is_true && finding.value("distance_holds", false);
    table.rows.push_back(
        {{finding.value("name", "")},
         metric_cell(finding, "position_error_m", 2),
         metric_cell(finding, "ahead_error_m", 2),
         metric_cell(finding, "radius_error_m", 2),
         {is_in_interval ? "contains the distance" : "does not contain it", is_in_interval ? Tone::kGood : Tone::kBad},
         is_true ? report::TableCell{"found", Tone::kGood} : report::TableCell{"false alarm", Tone::kBad}});
  }
  return {table, report::TextBlock{summary}};
}

}  // namespace

std::vector<report::Block> inspection_blocks(const io::Metrics& metrics) {
  std::vector<report::Block> blocks = leak_blocks(metrics);
  for (std::vector<report::Block>& more : std::array{lining_blocks(metrics), water_blocks(metrics)}) {
    std::move(more.begin(), more.end(), std::back_inserter(blocks));
  }
  return blocks;
}

std::vector<report::Block> performance_blocks(const io::Metrics& metrics) {
  if (!metrics.contains("performance") || !metrics["performance"].contains("parts_s")) return {};
  const io::Metrics& performance = metrics["performance"];
  const auto value = [&](const char* name) { return io::metric_at(performance, name).value_or(0.0); };
  report::BarBlock bars{.caption = fmt::format("Wall time by stage: {:.1f} s in total, {:.1f} s of processor time, "
                                               "{:.1f} simulated s per s, at most {:.0f} MB",
                                               value("wall_s"), value("cpu_s"), value("real_time_factor"),
                                               value("peak_memory_mb")),
                        .bars = {}};
  double rest_s = value("wall_s");
  for (const auto& [part, seconds] : performance["parts_s"].items()) {
    const double part_s = seconds.get<double>();
    rest_s -= part_s;
    bars.bars.push_back({.label = part, .value = part_s, .text = fmt::format("{:.2f} s", part_s)});
  }
  std::stable_sort(bars.bars.begin(), bars.bars.end(),
                   [](const report::Bar& a, const report::Bar& b) { return a.value > b.value; });
  if (rest_s > 0.0) bars.bars.push_back({.label = "other", .value = rest_s, .text = fmt::format("{:.2f} s", rest_s)});
  return {bars};
}

}  // namespace patrol::app
