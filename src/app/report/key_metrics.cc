#include <algorithm>
#include <optional>
#include <string>
#include <vector>

#include <fmt/format.h>

#include "app/report/metric_blocks.h"
#include "core/text.h"
#include "report/quantity.h"

namespace patrol::app {
namespace {

using report::KeyMetric;

class KeyMetricTable {
 public:
  explicit KeyMetricTable(const io::Metrics& metrics) : metrics_(metrics) {}

  std::optional<double> at(const std::string& path) const { return io::metric_at(metrics_, path); }
  void add(const std::string& label, const report::Quantity& quantity, const std::string& note) {
    rows_.push_back({label, quantity.value, quantity.unit, note});
  }
  std::vector<KeyMetric> take() { return std::move(rows_); }

  /// Adds the number of a list's entries for which `holds` is true, with the names of others, for which it is false.
  /// Adds nothing if no entry was measured.
  template <typename Holds>
  void add_count(const std::string& label, const std::string& list, const Holds& holds) {
    constexpr std::size_t kMaxNames = 3;
    if (!metrics_.contains(list) || metrics_[list].empty()) return;
    int num = 0;
    bool was_measured = false;
    std::vector<std::string> others;
    for (const io::Metrics& entry : metrics_[list]) {
      const std::optional<bool> is_true = holds(entry);
      was_measured = was_measured || is_true;
      num += is_true.value_or(false) ? 1 : 0;
      if (is_true == false) others.push_back(entry.value("name", ""));
    }
    if (!was_measured) return;
    const std::size_t num_more = others.size() - std::min(others.size(), kMaxNames);
    others.resize(others.size() - num_more);
    const std::string more = num_more > 0 ? fmt::format(" and {} more", num_more) : "";
    add(label, {fmt::format("{} of {}", num, metrics_[list].size()), ""},
        others.empty() ? "" : "not: " + join(others, ", ") + more);
  }

 private:
  const io::Metrics& metrics_;
  std::vector<KeyMetric> rows_;
};

/// Adds the reports of the robot that its true path contradicts.
void add_false_reports(KeyMetricTable& table) {
  if (table.at("mission.reported_completed").value_or(0.0) > table.at("mission.completed").value_or(0.0))
    table.add("Mission", {"NOT COMPLETED", ""}, "the true path contradicts the report of the robot");
  if (const double num = table.at("mission.false_arrivals").value_or(0.0); num > 0.0)
    table.add("FALSE ARRIVALS", {fmt::format("{:.0f}", num), ""}, "reported far from the true position");
}

void add_accuracy(KeyMetricTable& table) {
  if (const auto rmse_m = table.at("pose.site.ate_rmse_m")) {
    table.add("Position error in the survey, RMS", report::length(*rmse_m),
              "at most " + report::length(table.at("pose.site.ate_max_m").value_or(0.0)).text());
  }
  if (const auto rmse_m = table.at("pose.ate_rmse_m")) {
    table.add("Position error from the start, RMS", report::length(*rmse_m),
              "at most " + report::length(table.at("pose.ate_max_m").value_or(0.0)).text());
  }
  if (const auto rmse_deg = table.at("pose.heading_rmse_deg"))
    table.add("Heading error, RMS", report::angle(*rmse_deg), "");
  if (const auto mean_m = table.at("map.nearest_mean_m")) {
    table.add(
        "Map to nearest surface", report::length(*mean_m),
        fmt::format("{:.0f} % of the observable surfaces mapped", 100.0 * table.at("map.coverage").value_or(0.0)));
  }
  if (const auto rmse_m = table.at("odometry.ate_rmse_m"))
    table.add("Odometry alone, RMS", report::length(*rmse_m), "without map");
}

void add_goals(KeyMetricTable& table) {
  table.add_count("Stations reached", "stations", [](const io::Metrics& station) -> std::optional<bool> {
    const std::optional<double> reached = io::metric_at(station, "reached");
    return reached ? std::optional(*reached > 0.5) : std::nullopt;
  });
  table.add_count("Goals always reached", "goals", [](const io::Metrics& goal) -> std::optional<bool> {
    const std::optional<double> arrivals = io::metric_at(goal, "arrivals");
    return arrivals ? std::optional(*arrivals > 0.0 && io::metric_at(goal, "failed") == 0.0) : std::nullopt;
  });
  const double dockings = table.at("docking.arrivals").value_or(0.0), failed = table.at("docking.failed").value_or(0.0);
  if (dockings + failed > 0.0) {
    const auto worst_m = table.at("docking.position_error_m.max");
    table.add("Dockings", {fmt::format("{:.0f} of {:.0f}", dockings, dockings + failed), ""},
              worst_m ? "at most " + report::length(*worst_m).text() + " off" : "");
  }
}

/// Adds the found ones of the true `items` of an inspection, with the number of false findings.
void add_found(KeyMetricTable& table, const std::string& label, const std::string& inspection, const std::string& items,
               const std::string& false_findings, const std::string& false_name) {
  const double num_items = table.at(inspection + "." + items).value_or(0.0),
               num_false = table.at(inspection + "." + false_findings).value_or(0.0);
  if (num_items + num_false <= 0.0) return;
  table.add(label, {fmt::format("{:.0f} of {:.0f}", table.at(inspection + ".found").value_or(0.0), num_items), ""},
            fmt::format("{:.0f} {}", num_false, false_name));
}

void add_mission(KeyMetricTable& table) {
  const double leaks = table.at("inspection.leaks").value_or(0.0),
               alarms = table.at("inspection.false_alarms").value_or(0.0);
  if (const auto found = table.at("inspection.leaks_found"); found && leaks + alarms > 0.0) {
    table.add("Leaks found", {fmt::format("{:.0f} of {:.0f}", *found, leaks), ""},
              fmt::format("{:.0f} false alarms", alarms));
  }
  add_found(table, "Moved rings found", "inspection.lining", "moved_rings", "false_findings", "false findings");
  add_found(table, "Water bodies found", "inspection.water", "bodies", "false_alarms", "false alarms");
  if (const auto collisions = table.at("mission.collisions")) {
    table.add("Collisions", {fmt::format("{:.0f}", *collisions), ""},
              table.at("mission.fell").value_or(0.0) > 0.5 ? "and the robot fell" : "");
  }
  if (const auto distance_m = table.at("mission.distance_m")) {
    table.add("Distance", report::length(*distance_m),
              fmt::format("in {:.1f} s", table.at("mission.duration_s").value_or(0.0)));
  }
  if (const auto factor = table.at("performance.real_time_factor")) {
    table.add("Simulated s per wall s", {fmt::format("{:.1f}", *factor), ""}, "");
  }
}

}  // namespace

report::KeyMetrics key_metrics(const io::Metrics& metrics) {
  KeyMetricTable table(metrics);
  add_false_reports(table);
  add_accuracy(table);
  add_goals(table);
  add_mission(table);
  return {table.take()};
}

}  // namespace patrol::app
