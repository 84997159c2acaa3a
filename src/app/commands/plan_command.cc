#include <memory>
#include <string>
#include <vector>

#include <fmt/format.h>

#include "app/commands/commands.h"
#include "app/plan/plan_grid.h"
#include "app/plan/plan_map.h"
#include "app/plan/plan_settings.h"
#include "app/plan/problem_file.h"
#include "app/plan/problem_output.h"
#include "app/plan/route_metrics.h"
#include "app/plan/route_output.h"
#include "app/plan/route_picture.h"
#include "app/plan/tour_output.h"
#include "app/plan/tour_plan.h"
#include "core/error.h"
#include "io/files/csv.h"
#include "io/files/tour_stations.h"
#include "io/yaml/settings_yaml.h"

namespace patrol::app {
namespace {

void refuse_options_of_maps(const PlanOptions& options) {
  const std::pair<const char*, bool> given[] = {
      {"--from", options.from.has_value()},         {"--to", options.to.has_value()},
      {"--stations", options.stations.has_value()}, {"--robot", options.robot.has_value()},
      {"--radius-m", options.radius_m.has_value()}, {"--smooth", options.smooth}};
  for (const auto& [option, is_given] : given) {
    if (is_given)
      throw InputError(
          fmt::format("{}: not applicable to .scen files, which define their own point-robot problems", option));
  }
}

ExitCode interrupted() {
  fmt::print(stderr, "patrol: interrupted; nothing written\n");
  return ExitCode::kProgramFailed;
}

ExitCode plan_problems(const PlanOptions& options) {
  refuse_options_of_maps(options);
  const PlanSettings settings = load_plan_setup(options).settings;
  const std::optional<std::vector<SolvedProblem>> solved = solve_problems(options.map, settings);
  if (!solved) return interrupted();
  const ProblemReport report{.file_name = options.map.filename().string(), .settings = settings, .solved = *solved};
  if (options.out) {
    const OutputLock lock = begin_output(*options.out, kPlanOutput);
    io::save_csv(*options.out / "problems.csv", problem_table(report));
    io::save_metrics(*options.out / "plan.json", to_json(report));
    io::save_settings(*options.out / "settings.yaml", settings);
    complete_output(*options.out);
  }
  std::string text = to_text(report);
  if (options.out) text += (*options.out / "problems.csv").string() + "\n";
  print_result(options.form, text, to_json(report));
  return num_failed(report) == 0 ? ExitCode::kDone : ExitCode::kExpectationMissed;
}

/// Map, costs and ends of a planning problem.
struct Ground {
  PlanMap map;
  std::string map_name;
  PlanSetup setup;
  Eigen::Vector2d p_from_m;
  OccupancyGrid occupancy;
  Grid<plan::Cost> costs;

  bool is_blocked(const Eigen::Vector2d& p_m) const {
    return costs.at(costs.geometry().cell_at(p_m)) == plan::kLethalCost;
  }

  /// Message for a blocked point: "--to: 3, 4 is occupied; the nearest free cell is 2.5, 4, 0.50 m away".
  std::string blocked_message(const std::string& key, const Eigen::Vector2d& p_m) const {
    const std::string reason =
        fmt::format("{}: {} {}", key, map.text_of(p_m), blocked_reason(occupancy, setup.settings.costmap, p_m));
    const std::optional<Cell> free = nearest_free(costs, p_m);
    if (!free) return reason + "; the map has no free cell";
    const Eigen::Vector2d p_free_m = costs.geometry().center_of(*free);
    return fmt::format("{}; the nearest free cell is at {}, {:.2f} {} away", reason, map.text_of(p_free_m),
                       (p_free_m - p_m).norm(), map.unit());
  }
};

Ground load_ground(const PlanOptions& options) {
  PlanMap map(options.map);
  if (map.is_moving_ai() && (options.robot || options.radius_m)) {
    throw InputError(fmt::format(
        "{}: MovingAI maps have no metric resolution; --robot and --radius-m are not supported", options.map.string()));
  }
  PlanSetup setup = load_plan_setup(options);
  const Eigen::Vector2d p_from_m = map.parse_point("--from", options.from.value());
  OccupancyGrid occupancy = map.occupancy_from(p_from_m);
  Grid<plan::Cost> costs = make_costs(occupancy, setup.body, setup.settings.costmap);
  return {.map = std::move(map),
          .map_name = options.map.filename().string(),
          .setup = std::move(setup),
          .p_from_m = p_from_m,
          .occupancy = std::move(occupancy),
          .costs = std::move(costs)};
}

void save_picture(const std::filesystem::path& folder, const Ground& ground, const std::vector<Eigen::Vector2d>& line_m,
                  const std::vector<RoutePicture::Mark>& marks, const std::string& title) {
  render::save_png(folder / "route.png",
                   draw_route({.occupancy = ground.occupancy,
                               .costs = ground.costs,
                               .line_m = line_m,
                               .marks = marks,
                               .title = title,
                               .note = grid_text(ground.map_name, ground.map, ground.costs, ground.setup.body)}));
}

ExitCode plan_one(const PlanOptions& options) {
  const Ground ground = load_ground(options);
  const Eigen::Vector2d p_to_m = ground.map.parse_point("--to", options.to.value());
  const GridGeometry& grid = ground.costs.geometry();
  const RouteReport report{.map = ground.map,
                           .map_name = ground.map_name,
                           .setup = ground.setup,
                           .costs = ground.costs,
                           .p_from_m = ground.p_from_m,
                           .p_to_m = p_to_m,
                           .metrics = evaluate_route(ground.costs, grid.cell_at(ground.p_from_m), grid.cell_at(p_to_m),
                                                     ground.setup.settings)};
  const plan::Route& route = report.metrics.route;
  const bool is_found = route.status == plan::PlanStatus::kFound;
  if (options.out) {
    const OutputLock lock = begin_output(*options.out, kPlanOutput);
    const std::vector<Eigen::Vector2d> points_m = plan::to_meters(grid, route.points);
    if (is_found) io::save_csv(*options.out / "route.csv", route_table(ground.map, points_m));
    io::save_metrics(*options.out / "plan.json", to_json(report));
    io::save_settings(*options.out / "settings.yaml", ground.setup.settings);
    save_picture(*options.out, ground, points_m,
                 {{ground.p_from_m, "start", kStartColor}, {p_to_m, "goal", kGoalColor}}, route_title(report));
    complete_output(*options.out);
  }
  std::string text = to_text(report);
  if (route.status == plan::PlanStatus::kStartBlocked) text += ground.blocked_message("--from", ground.p_from_m) + "\n";
  if (!is_found && ground.is_blocked(p_to_m)) text += ground.blocked_message("--to", p_to_m) + "\n";
  if (options.out) text += (*options.out / "route.png").string() + "\n";
  print_result(options.form, text, to_json(report));
  return is_found ? ExitCode::kDone : ExitCode::kExpectationMissed;
}

std::vector<TourStop> load_stops(const std::filesystem::path& file, const PlanMap& map) {
  std::vector<TourStop> stops;
  for (const io::TourStation& station : io::load_tour_stations(file)) {
    stops.push_back({.station = station,
                     .p_m = map.parse_point(fmt::format("{}:{}: {}", file.string(), station.line, station.name),
                                            station.x, station.y)});
  }
  return stops;
}

ExitCode plan_stations(const PlanOptions& options) {
  const Ground ground = load_ground(options);
  const std::vector<TourStop> stops = load_stops(*options.stations, ground.map);
  const std::optional<Eigen::Vector2d> p_end_m =
      options.to ? std::optional(ground.map.parse_point("--to", *options.to)) : std::nullopt;
  const std::optional<TourPlan> tour = plan_tour(ground.costs, ground.p_from_m, stops, p_end_m, ground.setup.settings);
  if (!tour) return interrupted();
  const TourReport report{.map = ground.map,
                          .map_name = ground.map_name,
                          .setup = ground.setup,
                          .costs = ground.costs,
                          .p_from_m = ground.p_from_m,
                          .p_end_m = p_end_m,
                          .stops = stops,
                          .tour = *tour};
  if (options.out) {
    const OutputLock lock = begin_output(*options.out, kPlanOutput);
    if (tour->order.is_found) {
      io::save_csv(*options.out / "tour.csv", tour_table(report));
      io::save_csv(*options.out / "route.csv", route_table(ground.map, tour->points_m));
    }
    io::save_metrics(*options.out / "plan.json", to_json(report));
    io::save_settings(*options.out / "settings.yaml", ground.setup.settings);
    save_picture(*options.out, ground, tour->points_m, marks_of(report), tour_title(report));
    complete_output(*options.out);
  }
  std::string text = to_text(report);
  if (ground.is_blocked(ground.p_from_m)) text += ground.blocked_message("--from", ground.p_from_m) + "\n";
  for (const std::size_t node : tour->unreachable) {
    const Eigen::Vector2d p_m = node <= stops.size() ? stops[node - 1].p_m : *p_end_m;
    if (ground.is_blocked(p_m)) text += ground.blocked_message(node_name(report, node), p_m) + "\n";
  }
  if (options.out) text += (*options.out / "route.png").string() + "\n";
  print_result(options.form, text, to_json(report));
  return tour->order.is_found && tour->unreachable.empty() && tour->order.lateness <= 0.0
             ? ExitCode::kDone
             : ExitCode::kExpectationMissed;
}

}  // namespace

ExitCode plan_command(const PlanOptions& options) {
  const std::string extension = options.map.extension().string();
  if (extension == ".scen") return plan_problems(options);
  if (extension != ".yaml" && extension != ".yml" && extension != ".map") {
    throw InputError(fmt::format("{}: unknown file type (known: .yaml of map_server, .map and .scen of MovingAI)",
                                 options.map.string()));
  }
  if (!options.from) throw InputError("--from: required");
  if (options.stations) return plan_stations(options);
  if (!options.to) throw InputError("--to: required unless --stations is given");
  return plan_one(options);
}

}  // namespace patrol::app
