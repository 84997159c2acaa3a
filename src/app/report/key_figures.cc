#include <optional>

#include <fmt/format.h>

#include "app/report/metric_blocks.h"
#include "report/quantity.h"

namespace patrol::app {
namespace {

using report::KeyMetric;

class Figures {
 public:
  explicit Figures(const io::Metrics& metrics) : metrics_(metrics) {}

  std::optional<double> at(const std::string& path) const { return io::metric_at(metrics_, path); }
  void add(const std::string& label, const report::Quantity& quantity, const std::string& note) {
    figures_.push_back({label, quantity.value, quantity.unit, note});
  }
  std::vector<KeyMetric> take() { return std::move(figures_); }

  /// Adds the number of a list's entries for which `holds` is true.
  template <typename Holds>
  void add_share(const std::string& label, const std::string& list, const Holds& holds, const std::string& note) {
    if (!metrics_.contains(list) || metrics_[list].empty()) return;
    int num = 0;
    for (const io::Metrics& entry : metrics_[list]) num += holds(entry) ? 1 : 0;
    add(label, {fmt::format("{} of {}", num, metrics_[list].size()), ""}, note);
  }

 private:
  const io::Metrics& metrics_;
  std::vector<KeyMetric> figures_;
};

void add_accuracy(Figures& figures) {
  if (const auto rmse_m = figures.at("pose.ate_rmse_m")) {
    figures.add("Position error, RMS", report::length(*rmse_m), "at most " + report::length(figures.at("pose.ate_max_m").value_or(0.0)).text());
  }
  if (const auto rmse_deg = figures.at("pose.heading_rmse_deg")) figures.add("Heading error, RMS", report::angle(*rmse_deg), "");
  if (const auto mean_m = figures.at("map.nearest_mean_m")) {
    figures.add("Map to nearest surface", report::length(*mean_m), fmt::format("{:.0f} % of what could be seen is mapped", 100.0 * figures.at("map.coverage").value_or(0.0)));
  }
  if (const auto rmse_m = figures.at("odometry.ate_rmse_m")) figures.add("Odometry alone, RMS", report::length(*rmse_m), "the same without map");
}

void add_places(Figures& figures) {
  const auto is_reached = [](const io::Metrics& station) { return station.value("reached", false); };
  figures.add_share("Stations reached", "stations", is_reached, "");
  const auto is_always_reached = [](const io::Metrics& goal) { return goal.value("arrivals", 0) > 0 && goal.value("failed", 0) == 0; };
  figures.add_share("Goals always reached", "goals", is_always_reached, "");
  const double dockings = figures.at("docking.arrivals").value_or(0.0), failed = figures.at("docking.failed").value_or(0.0);
  if (dockings + failed > 0.0) {
    const auto worst_m = figures.at("docking.position_error_m.max");
    figures.add("Dockings", {fmt::format("{:.0f} of {:.0f}", dockings, dockings + failed), ""}, worst_m ? "at most " + report::length(*worst_m).text() + " off" : "");
  }
}

void add_mission(Figures& figures) {
  const double leaks = figures.at("inspection.leaks").value_or(0.0), alarms = figures.at("inspection.false_alarms").value_or(0.0);
  if (leaks + alarms > 0.0) {
    figures.add("Leaks found", {fmt::format("{:.0f} of {:.0f}", figures.at("inspection.leaks_found").value_or(0.0), leaks), ""},
                fmt::format("{:.0f} false alarms", alarms));
  }
  if (const auto collisions = figures.at("mission.collisions")) {
    figures.add("Collisions", {fmt::format("{:.0f}", *collisions), ""}, figures.at("mission.fell").value_or(0.0) > 0.5 ? "and the robot fell" : "");
  }
  if (const auto distance_m = figures.at("mission.distance_m")) {
    figures.add("Way", report::length(*distance_m), fmt::format("in {:.1f} s", figures.at("mission.duration_s").value_or(0.0)));
  }
  if (const auto factor = figures.at("performance.real_time_factor")) {
    figures.add("Simulated s per wall s", {fmt::format("{:.1f}", *factor), ""}, "");
  }
}

}  // namespace

report::KeyMetrics key_figures(const io::Metrics& metrics) {
  Figures figures(metrics);
  add_accuracy(figures);
  add_places(figures);
  add_mission(figures);
  return {figures.take()};
}

}  // namespace patrol::app
