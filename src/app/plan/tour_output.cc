#include "app/plan/tour_output.h"

#include <algorithm>

#include <fmt/format.h>

#include "app/plan/route_metrics.h"
#include "app/plan/route_output.h"
#include "core/text.h"

namespace patrol::app {
namespace {

Eigen::Vector2d node_position(const TourReport& report, std::size_t node) {
  if (node == 0) return report.p_from_m;
  return node <= report.stops.size() ? report.stops[node - 1].p_m : *report.p_end_m;
}

std::vector<std::string> unreachable_names(const TourReport& report) {
  std::vector<std::string> names;
  for (const std::size_t node : report.tour.unreachable) names.push_back(node_name(report, node));
  return names;
}

double length_m(const TourPlan& tour) {
  double length_m = 0.0;
  for (const TourVisit& visit : tour.visits) length_m += visit.leg_m;
  return length_m;
}

std::string windows_text(const TourPlan& tour) {
  const auto num_late =
      std::count_if(tour.visits.begin(), tour.visits.end(), [](const TourVisit& visit) { return visit.late_s > 0.0; });
  if (num_late == 0) return "every window kept";
  return fmt::format("{} window{} missed, by {:.1f} s in total", num_late, num_late == 1 ? "" : "s",
                     tour.order.lateness);
}

double waiting_s(const TourPlan& tour) {
  double waiting_s = 0.0;
  for (const TourVisit& visit : tour.visits) waiting_s += visit.waits_s;
  return waiting_s;
}

/// Table of the stops; the column of names is as wide as the longest one, at most 32 characters.
std::string visits_text(const TourReport& report) {
  std::size_t width = 5;
  for (const TourStop& stop : report.stops) width = std::clamp(stop.station.name.size(), width, std::size_t{32});
  std::string text =
      fmt::format("     {:<{}}  {:>10}  {:>10}  {:>10}  {:>10}  {:>10}\n", "", width,
                  fmt::format("path, {}", report.map.unit()), "arrives, s", "waits, s", "leaves, s", "late, s");
  std::size_t number = 0;
  for (const TourVisit& visit : report.tour.visits) {
    const std::string late = visit.late_s > 0.0 ? fmt::format("{:.1f}", visit.late_s) : "";
    const std::string line = fmt::format("{:>3}  {:<{}}  {:>10.2f}  {:>10.1f}  {:>10.1f}  {:>10.1f}  {:>10}", number++,
                                         node_name(report, visit.node), width, visit.leg_m, visit.arrives_s,
                                         visit.waits_s, visit.leaves_s, late);
    text += line.substr(0, line.find_last_not_of(' ') + 1) + "\n";
  }
  return text;
}

}  // namespace

std::string node_name(const TourReport& report, std::size_t node) {
  if (node == 0) return "start";
  return node <= report.stops.size() ? report.stops[node - 1].station.name : "end";
}

std::string tour_title(const TourReport& report) {
  const TourPlan& tour = report.tour;
  if (!tour.order.is_found)
    return fmt::format("{}: no tour of {} stations", report.setup.settings.planner, report.stops.size());
  // All unreachable places are stations: without a path to the end there is no order.
  return fmt::format("{}: {} of {} stations in {:.2f} {}, {:.1f} s", report.setup.settings.planner,
                     report.stops.size() - tour.unreachable.size(), report.stops.size(), length_m(tour),
                     report.map.unit(), tour.order.completion);
}

std::string to_text(const TourReport& report) {
  const TourPlan& tour = report.tour;
  const char* unit = report.map.unit();
  std::string text = fmt::format("{}\n{}\n", tour_title(report),
                                 grid_text(report.map_name, report.map, report.costs, report.setup.body));
  if (tour.order.is_found) {
    text += visits_text(report);
    text += fmt::format("completion   {:.1f} s at {} {}/s: {:.1f} s of it waiting; {}\n", tour.order.completion,
                        report.setup.settings.speed_mps, unit, waiting_s(tour), windows_text(tour));
    text +=
        tour.order.is_exact
            ? fmt::format("order        optimal, by exact search (lower bound {:.1f} s)\n", tour.order.lower_bound)
            : fmt::format("order        by local search: at most {:.2f} % above the optimum, lower bound {:.1f} s\n",
                          100.0 * tour.order.gap(), tour.order.lower_bound);
  } else if (tour.unreachable.size() + 1 < report.stops.size() + 1 + (report.p_end_m.has_value() ? 1 : 0)) {
    text += "no order: some stations are not connected\n";
  }
  text += fmt::format("paths        {} planned, {:.2f} ms each\n", tour.num_routes,
                      1e3 * tour.processor_s / std::max(1, tour.num_routes));
  if (!tour.unreachable.empty()) {
    text += fmt::format("UNREACHABLE  {}{}\n", join(unreachable_names(report), ", "),
                        tour.is_proven ? "" : ": this planner is not complete");
  }
  return text;
}

io::Metrics to_json(const TourReport& report) {
  const TourPlan& tour = report.tour;
  const char* unit = report.map.unit();
  io::Metrics visits = io::Metrics::array();
  for (const TourVisit& visit : tour.visits) {
    visits.push_back({{"name", node_name(report, visit.node)},
                      {fmt::format("way_{}", unit), visit.leg_m},
                      {"arrives_s", visit.arrives_s},
                      {"waits_s", visit.waits_s},
                      {"leaves_s", visit.leaves_s},
                      {"late_s", visit.late_s}});
  }
  const auto value_or_null = [&](double value) {
    return tour.order.is_found ? io::Metrics(value) : io::Metrics(nullptr);
  };
  return {{"map", report.map_name},
          {"grid", grid_json(report.map, report.costs, report.setup.body)},
          {"planner", report.setup.settings.planner},
          {"seed", report.setup.settings.seed},
          {"speed_mps", report.setup.settings.speed_mps},
          {"tour",
           {{"is_found", tour.order.is_found},
            {"is_exact", tour.order.is_exact},
            {fmt::format("length_{}", unit), value_or_null(length_m(tour))},
            {"completion_s", value_or_null(tour.order.completion)},
            {"waiting_s", value_or_null(waiting_s(tour))},
            {"lateness_s", value_or_null(tour.order.lateness)},
            {"lower_bound_s", value_or_null(tour.order.lower_bound)},
            {"gap", value_or_null(tour.order.gap())},
            {"unreachable", unreachable_names(report)}}},
          {"visits", visits},
          {"performance", {{"num_ways", tour.num_routes}, {"processor_s", tour.processor_s}}}};
}

io::Table tour_table(const TourReport& report) {
  const std::string unit = report.map.unit();
  io::Table table{
      .name = "tour",
      .columns = {"name", "x_" + unit, "y_" + unit, "way_" + unit, "arrives_s", "waits_s", "leaves_s", "late_s"},
      .rows = {}};
  for (const TourVisit& visit : report.tour.visits) {
    const Eigen::Vector2d p = report.map.to_user(node_position(report, visit.node));
    table.rows.push_back({node_name(report, visit.node), p.x(), p.y(), visit.leg_m, visit.arrives_s, visit.waits_s,
                          visit.leaves_s, visit.late_s});
  }
  return table;
}

std::vector<RoutePicture::Mark> marks_of(const TourReport& report) {
  std::vector<RoutePicture::Mark> marks = {{report.p_from_m, "start", kStartColor}};
  for (std::size_t k = 1; k < report.tour.visits.size(); ++k) {
    const std::size_t node = report.tour.visits[k].node;
    if (node == 0 || node > report.stops.size()) continue;
    marks.push_back({node_position(report, node), fmt::format("{} {}", k, node_name(report, node)), kStopColor});
  }
  for (const std::size_t node : report.tour.unreachable)
    marks.push_back({node_position(report, node), node_name(report, node) + ": no path", kGoalColor});
  const bool is_end_reached = report.tour.unreachable.empty() || report.tour.unreachable.back() <= report.stops.size();
  if (report.p_end_m && is_end_reached) marks.push_back({*report.p_end_m, "end", kGoalColor});
  return marks;
}

}  // namespace patrol::app
