#include "app/study/planner_study.h"

#include <array>
#include <limits>
#include <optional>
#include <utility>

#include <fmt/format.h>

#include "app/study/planner_problem.h"
#include "core/thread_cpu_time.h"
#include "plan/routes/planners.h"
#include "report/map_picture.h"

namespace patrol::app {
namespace {

using report::SeriesColor;

constexpr double kNoPlannerMetric = std::numeric_limits<double>::quiet_NaN();
constexpr int kMaxStepsMillions = 50;  // of ants, particles and episodes, per planning

struct PlannerWorld {
  std::string name;
  std::function<PlannerProblem(std::uint64_t seed)> problem;
};

std::vector<PlannerWorld> planner_worlds() {
  std::vector<PlannerWorld> worlds;
  for (const char* const kind : {"random", "rooms", "maze"}) {
    for (const int size : {50, 100, 200}) {
      worlds.push_back({fmt::format("{} {} x {}", kind, size, size),
                        [=](std::uint64_t seed) { return generated_problem(kind, size, seed); }});
    }
  }
  for (const char* const world : {"street", "tunnel", "substation"}) {
    worlds.push_back({world, [=](std::uint64_t seed) { return world_problem(world, seed); }});
  }
  return worlds;
}

struct PlannerMethod {
  const char* title = "";
  const char* name = "";  ///< name of the planner
  bool iterates = false;
  SeriesColor color = SeriesColor::kTruth;
  bool tightens = true;  ///< improved colony only: extension
};

/// Methods; all others are compared with the first. The last two are lower bounds, over eight neighbors and over all
/// paths.
constexpr std::array<PlannerMethod, 9> kPlannerMethods = {
    {{"improved ant colony (this work)", "ant_colony_li22", true, SeriesColor::kEstimate},
     {"ant colony [Li22]", "ant_colony_li22", true, SeriesColor::kEvent, false},
     {"ant system", "ant_system", true, SeriesColor::kOdometry},
     {"dual swarm", "dual_swarm_pso", true, SeriesColor::kRanges},
     {"Q-learning", "q_learning", true, SeriesColor::kAlarm},
     {"Theta*", "theta_star", false, SeriesColor::kEvent},
     {"Dijkstra", "dijkstra", false, SeriesColor::kConfidence},
     {"A*", "astar", false, SeriesColor::kTruth},
     {"any-angle optimum", "visibility_graph", false, SeriesColor::kBound}}};
constexpr std::size_t kAstar = 7, kOptimum = 8;

const std::vector<studies::StudyMetric> kPlannerMetrics = {
    {.name = "longer than A*", .unit = "%", .is_compared = true},
    {.name = "iterations to 1 % of its final value", .unit = "", .is_compared = true},
    {.name = "iterations to A* + 3 %", .unit = ""},
    {.name = "found", .unit = "%"},
    {.name = "over any-angle", .unit = "%"},
    {.name = "clearance", .unit = "cells"},
    {.name = "steps", .unit = "1000"},
    {.name = "time", .unit = "ms", .is_processor_time = true}};

struct Planned {
  plan::Route route;
  double seconds = 0.0;  ///< processor time
};

Planned plan_by(const PlannerMethod& method, const PlannerProblem& problem, std::uint64_t seed) {
  plan::RoutePlannerSettings settings{.max_steps_millions = kMaxStepsMillions};
  settings.improved_colony.shorten_paths = method.tightens;
  settings.ant_colony.threads = 1;  // seeds run in parallel
  const auto planner = plan::make_route_planner(method.name, settings, seed);
  const double start_s = thread_cpu_time_s();
  Planned planned{.route = planner->plan(problem.costs, problem.start, problem.goal)};
  planned.seconds = thread_cpu_time_s() - start_s;
  return planned;
}

/// Iteration, from 1, at which the length is reached; NaN if never.
double iterations_to_length(const std::vector<double>& history, double length) {
  for (std::size_t i = 0; i < history.size(); ++i) {
    if (history[i] <= length) return static_cast<double>(i + 1);
  }
  return kNoPlannerMetric;
}

std::vector<std::vector<double>> flatten_metrics(const std::array<Planned, kPlannerMethods.size()>& all) {
  std::vector<std::vector<double>> metrics;
  const double astar = all[kAstar].route.length, optimum = all[kOptimum].route.length;
  for (std::size_t m = 0; m < kPlannerMethods.size(); ++m) {
    const plan::Route& route = all[m].route;
    const bool is_found = route.status == plan::PlanStatus::kFound, iterates = kPlannerMethods[m].iterates && is_found;
    metrics.push_back({is_found ? 100.0 * (route.length / astar - 1.0) : kNoPlannerMetric,
                       iterates ? plan::iterations_to_convergence(route.history, 0.01) : kNoPlannerMetric,
                       iterates ? iterations_to_length(route.history, 1.03 * astar) : kNoPlannerMetric,
                       is_found ? 100.0 : 0.0, is_found ? 100.0 * (route.length / optimum - 1.0) : kNoPlannerMetric,
                       is_found ? route.clearance : kNoPlannerMetric, 1e-3 * static_cast<double>(route.num_expanded),
                       1e3 * all[m].seconds});
  }
  return metrics;
}

std::array<Planned, kPlannerMethods.size()> plan_all(const PlannerProblem& problem, std::uint64_t seed) {
  std::array<Planned, kPlannerMethods.size()> all;
  for (std::size_t m = 0; m < kPlannerMethods.size(); ++m) all[m] = plan_by(kPlannerMethods[m], problem, seed);
  return all;
}

studies::StudySample run_planners(const std::vector<PlannerWorld>& worlds, std::uint64_t seed) {
  studies::StudySample sample;
  for (const PlannerWorld& world : worlds) {
    for (std::vector<double>& metrics : flatten_metrics(plan_all(world.problem(seed), seed)))
      sample.push_back(std::move(metrics));
  }
  return sample;
}

/// Figure 1: excess of the best route found until then over A*'s length, in the first two hundred iterations.
report::LinePlot convergence(const std::array<Planned, kPlannerMethods.size()>& all, const std::string& world) {
  constexpr std::size_t kShown = 200;
  constexpr double kMaxExcess = 25.0;
  report::LinePlot plot{.title = fmt::format("Excess length over A*, best route up to the iteration: {}", world),
                        .unit = "%",
                        .axis = {.label = "iteration", .max = kShown},
                        .max = kMaxExcess,
                        .curves = {},
                        .marks = {},
                        .spans = {}};
  for (std::size_t m = 0; m < kPlannerMethods.size(); ++m) {
    if (!kPlannerMethods[m].iterates) continue;
    report::Curve curve{
        .name = kPlannerMethods[m].title, .color = kPlannerMethods[m].color, .is_dashed = false, .points = {}};
    for (std::size_t i = 0; i < kShown; ++i) {
      const std::vector<double>& history = all[m].route.history;
      const double excess =
          i < history.size() ? 100.0 * (history[i] / all[kAstar].route.length - 1.0) : kNoPlannerMetric;
      if (excess <= kMaxExcess) curve.points.emplace_back(static_cast<double>(i + 1), excess);
    }
    plot.curves.push_back(std::move(curve));
  }
  return plot;
}

report::MapBlock routes_on(const PlannerProblem& problem, const std::array<Planned, kPlannerMethods.size()>& all) {
  const GridGeometry& grid = problem.costs.geometry();
  OccupancyGrid map(grid, kFree);
  for (std::size_t i = 0; i < map.values().size(); ++i) {
    if (problem.costs.values()[i] == plan::kLethalCost) map.values()[i] = kOccupied;
  }
  report::MapBlock block;
  Eigen::AlignedBox2d shown(grid.origin_m);
  shown.extend(grid.origin_m + grid.resolution_m * Eigen::Vector2d(grid.width, grid.height));
  block.picture = report::map_picture({.built = map, .T_world_map = {}, .truth = {}, .error_m = {}}, shown);
  for (std::size_t m = 0; m < kPlannerMethods.size(); ++m) {
    if (m != kOptimum && !kPlannerMethods[m].iterates) continue;
    block.paths.push_back(
        {kPlannerMethods[m].title, kPlannerMethods[m].color, {plan::to_meters(grid, all[m].route.points)}});
  }
  for (const auto& [label, cell] : {std::pair("start", problem.start), std::pair("goal", problem.goal)}) {
    block.marks.push_back({.label = label, .color = SeriesColor::kTruth, .p_m = grid.center_of(cell)});
  }
  return block;
}

std::vector<report::Section> illustrate_planners(const std::vector<PlannerWorld>& worlds, std::uint64_t seed) {
  report::Section plots{fmt::format("Convergence, seed {}", seed), {}};
  std::vector<report::Section> maps;
  for (const PlannerWorld& world : worlds) {
    const PlannerProblem problem = world.problem(seed);
    const std::array<Planned, kPlannerMethods.size()> all = plan_all(problem, seed);
    plots.blocks.emplace_back(convergence(all, world.name));
    maps.push_back({fmt::format("Routes, {}, seed {}", world.name, seed), {routes_on(problem, all)}});
  }
  maps.insert(maps.begin(), std::move(plots));
  return maps;
}

}  // namespace

studies::Study planner_study() {
  std::vector<PlannerWorld> worlds = planner_worlds();
  studies::Study study{
      .name = "planners",
      .title = "Global planners compared with the ant colony of [Li22]",
      .source = "[Li22], figures 1 to 4 (no readable values)",
      .conditions =
          "Every seed generates new grids, or new start and goal positions on the map of a world (its surfaces "
          "at the height of the lidar in cells of 0.2 m, inflated by the footprint of its robot). Eight "
          "neighbors, no corner cutting; lengths in cells. Ant colonies: 80 ants, 200 iterations; dual swarm: "
          "two swarms of 40, 200 iterations; Q-learning: 5000 episodes; at most 50 million steps each. Improved "
          "ant colony: that of [Li22], with paths shortened before they are compared (this work). Over "
          "any-angle: excess over the shortest any-angle path, which touches corners. Default settings, chosen "
          "on generated grids of other seeds. A planner that improves late and one that converges at once both "
          "need few iterations to 1 % of their own final value. The iterations to 3 % above A* distinguish "
          "them, over the seeds that reach it. Q-learning and dual swarms are of the kinds that [Li22] compares "
          "with; their sources were not available.",
      .default_seeds = 30,
      .compared_with = "the improved ant colony",
      .metrics = kPlannerMetrics};
  for (const PlannerWorld& world : worlds) {
    const std::size_t reference = study.variants.size();
    for (const PlannerMethod& method : kPlannerMethods)
      study.variants.push_back({.world = world.name, .method = method.title, .particles = 0, .reference = reference});
  }
  study.illustrate = [worlds](std::uint64_t seed) { return illustrate_planners(worlds, seed); };
  study.run = [worlds = std::move(worlds)](std::uint64_t seed) { return run_planners(worlds, seed); };
  return study;
}

}  // namespace patrol::app
