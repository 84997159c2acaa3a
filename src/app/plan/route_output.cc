#include "app/plan/route_output.h"

#include <cmath>

#include <fmt/format.h>

#include "app/plan/plan_grid.h"

namespace patrol::app {

const OutputKind kPlanOutput = {
    .name = "plan",
    .marker_text = "Incomplete plan.",
    .outputs = {"route.csv", "tour.csv", "problems.csv", "plan.json", "settings.yaml", "route.png", "*.part"},
    .required_file = "settings.yaml",
    .preserved = {}};

namespace {

constexpr double kSettled = 0.01;  // fraction of the final value

std::string turns_text(int num_turns) { return fmt::format("{} turn{}", num_turns, num_turns == 1 ? "" : "s"); }

std::string compared(double value, double best) {
  const double percent = 100.0 * gap(value, best);
  if (std::abs(percent) < 0.005) return "equal to the route";
  return fmt::format("route {:.2f} % {}", std::abs(percent), percent > 0.0 ? "more" : "less");
}

/// Lines on the optimal routes of this grid.
std::string references_text(const RouteReport& report) {
  const RouteMetrics& metrics = report.metrics;
  const double cell = report.costs.geometry().resolution_m;
  const char* unit = report.map.unit();
  const bool is_found = metrics.route.status == plan::PlanStatus::kFound;
  if (!metrics.octile_length) return fmt::format("octile optimum     none: A* finds no route either\n");
  const auto line = [&](const char* name, double best, double value) {
    return fmt::format("{:<18} {:.3f} {}{}\n", name, cell * best, unit, is_found ? ": " + compared(value, best) : "");
  };
  std::string text = line("octile optimum", *metrics.octile_length, metrics.route.length);
  if (metrics.octile_cost) text += line("  cheapest, cost", *metrics.octile_cost, metrics.route.cost);
  if (metrics.any_angle_length) text += line("any-angle optimum", *metrics.any_angle_length, metrics.route.length);
  if (metrics.is_any_angle_skipped) {
    const std::int64_t max_cells = report.setup.settings.max_any_angle_cells;
    text +=
        fmt::format("any-angle optimum  skipped: more than {} passable cells, or {} in total (max_any_angle_cells)\n",
                    max_cells, 8 * max_cells);
  }
  return text;
}

}  // namespace

const char* status_name(plan::PlanStatus status) {
  switch (status) {
    case plan::PlanStatus::kFound:
      return "found";
    case plan::PlanStatus::kStartBlocked:
      return "start blocked";
    case plan::PlanStatus::kGoalBlocked:
      return "goal blocked";
    case plan::PlanStatus::kNoRoute:
      return "no route";
    case plan::PlanStatus::kNotFound:
      return "none found";
  }
  return "";
}

std::string grid_text(const std::string& map_name, const PlanMap& map, const Grid<plan::Cost>& costs,
                      const PlanBody& body) {
  const GridGeometry& grid = costs.geometry();
  const std::string cell = map.is_moving_ai() ? "" : fmt::format(" of {} m", grid.resolution_m);
  return fmt::format("{}: {} x {} cells{}, {} passable by {}", map_name, grid.width, grid.height, cell,
                     num_passable(costs), body.name);
}

std::string route_title(const RouteReport& report) {
  const plan::Route& route = report.metrics.route;
  const double cell = report.costs.geometry().resolution_m;
  std::string what = status_name(route.status);
  if (route.status == plan::PlanStatus::kFound)
    what = fmt::format("{:.3f} {}, {}", cell * route.length, report.map.unit(), turns_text(report.metrics.num_turns));
  return fmt::format("{} from {} to {}: {}", report.setup.settings.planner, report.map.text_of(report.p_from_m),
                     report.map.text_of(report.p_to_m), what);
}

std::string to_text(const RouteReport& report) {
  const RouteMetrics& metrics = report.metrics;
  const plan::Route& route = metrics.route;
  const double cell = report.costs.geometry().resolution_m, weight = report.setup.settings.routes.cost_weight;
  const char* unit = report.map.unit();
  const bool is_found = route.status == plan::PlanStatus::kFound;
  std::string text = fmt::format("{} from {} to {}\n{}\n", report.setup.settings.planner,
                                 report.map.text_of(report.p_from_m), report.map.text_of(report.p_to_m),
                                 grid_text(report.map_name, report.map, report.costs, report.setup.body));
  text += fmt::format("status             {}{}{}\n", status_name(route.status),
                      is_found && report.setup.settings.smooth ? ", smoothed" : "",
                      route.status == plan::PlanStatus::kNotFound ? ": this planner is not complete" : "");
  if (is_found) {
    text += fmt::format("length             {:.3f} {}, {} points, {}\n", cell * route.length, unit, route.points.size(),
                        turns_text(metrics.num_turns));
    if (weight > 0.0)
      text += fmt::format("cost               {:.3f} {}: a cell at the highest passable cost counts as {}\n",
                          cell * route.cost, unit, 1.0 + weight);
    text += fmt::format("clearance          {}{:.3f} {} to lethal cells\n",
                        route.clearance >= plan::kMaxClearance ? "at least " : "", cell * route.clearance, unit);
  }
  text += fmt::format("iterations         {}", route.num_iterations);
  if (const int settled = plan::iterations_to_convergence(route.history, kSettled))
    text += fmt::format(", within 1 % of the final value from {} on", settled);
  text += fmt::format("\nexpanded           {} cells\nprocessor time     {:.2f} ms\n", route.num_expanded,
                      1e3 * metrics.processor_s);
  return text + references_text(report);
}

io::Metrics grid_json(const PlanMap& map, const Grid<plan::Cost>& costs, const PlanBody& body) {
  const GridGeometry& grid = costs.geometry();
  return {{"unit", map.unit()},          {"resolution_m", grid.resolution_m},     {"width_cells", grid.width},
          {"height_cells", grid.height}, {"passable_cells", num_passable(costs)}, {"body", body.name}};
}

io::Metrics to_json(const RouteReport& report) {
  const RouteMetrics& metrics = report.metrics;
  const plan::Route& route = metrics.route;
  const double cell = report.costs.geometry().resolution_m;
  const bool is_found = route.status == plan::PlanStatus::kFound;
  const auto key = [&](const char* name) { return fmt::format("{}_{}", name, report.map.unit()); };
  const auto value_or_null = [](bool is_known, auto value) {
    return is_known ? io::Metrics(value) : io::Metrics(nullptr);
  };
  const auto point_json = [&](const Eigen::Vector2d& p_m) {
    return io::Metrics{report.map.to_user(p_m).x(), report.map.to_user(p_m).y()};
  };
  const auto best = [&](const std::optional<double>& value) {
    return value ? io::Metrics(cell * *value) : io::Metrics(nullptr);
  };
  const auto gap_to = [&](double value, const std::optional<double>& reference) {
    return is_found && reference ? io::Metrics(gap(value, *reference)) : io::Metrics(nullptr);
  };
  return {{"map", report.map_name},
          {"grid", grid_json(report.map, report.costs, report.setup.body)},
          {"planner", report.setup.settings.planner},
          {"seed", report.setup.settings.seed},
          {key("from"), point_json(report.p_from_m)},
          {key("to"), point_json(report.p_to_m)},
          {"status", status_name(route.status)},
          {"route",
           {{key("length"), value_or_null(is_found, cell * route.length)},
            {key("cost"), value_or_null(is_found, cell * route.cost)},
            {key("clearance"), value_or_null(is_found, cell * route.clearance)},
            {"turns", metrics.num_turns},
            {"points", route.points.size()},
            {"iterations", route.num_iterations},
            {"iterations_to_1_percent", plan::iterations_to_convergence(route.history, kSettled)},
            {"expanded_cells", route.num_expanded}}},
          {"references",
           {{key("octile_length"), best(metrics.octile_length)},
            {"gap_to_octile", gap_to(route.length, metrics.octile_length)},
            {key("octile_cost"), best(metrics.octile_cost)},
            {"gap_to_octile_cost", gap_to(route.cost, metrics.octile_cost)},
            {key("any_angle_length"), best(metrics.any_angle_length)},
            {"gap_to_any_angle", gap_to(route.length, metrics.any_angle_length)}}},
          {"performance", {{"processor_s", metrics.processor_s}, {"wall_s", metrics.wall_s}}}};
}

io::Table route_table(const PlanMap& map, const std::vector<Eigen::Vector2d>& points_m) {
  io::Table table{
      .name = "route", .columns = {fmt::format("x_{}", map.unit()), fmt::format("y_{}", map.unit())}, .rows = {}};
  const auto round_to_micrometers = [](double x) { return std::round(1e6 * x) / 1e6; };
  for (const Eigen::Vector2d& p_m : points_m)
    table.rows.push_back({round_to_micrometers(map.to_user(p_m).x()), round_to_micrometers(map.to_user(p_m).y())});
  return table;
}

}  // namespace patrol::app
