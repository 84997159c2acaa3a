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

constexpr double kNoPlannerFigure = std::numeric_limits<double>::quiet_NaN();
constexpr int kMaxStepsMillions = 50;  // of ants, particles and episodes, per planning

struct PlannerWorld {
  std::string name;
  std::function<PlannerProblem(std::uint64_t seed)> problem;
};

std::vector<PlannerWorld> planner_worlds() {
  std::vector<PlannerWorld> worlds;
  for (const char* const kind : {"random", "rooms", "maze"}) {
    for (const int size : {50, 100, 200}) {
      worlds.push_back({fmt::format("{} {} x {}", kind, size, size), [=](std::uint64_t seed) { return generated_problem(kind, size, seed); }});
    }
  }
  for (const char* const world : {"street", "tunnel", "substation"}) {
    worlds.push_back({world, [=](std::uint64_t seed) { return world_problem(world, seed); }});
  }
  return worlds;
}

struct PlannerMethod {
  const char* title;
  const char* name;  ///< name of the planner
  bool iterates;
  SeriesColor color;
  bool tightens = true;  ///< improved colony only: extension
};

/// Methods; all others are compared with the first. The last two are lower bounds, over eight neighbors and over all
/// paths.
constexpr std::array<PlannerMethod, 9> kPlannerMethods = {{{"improved ants (ours)", "ant_colony", true, SeriesColor::kEstimate},
                                                    {"ants of [Li22]", "ant_colony", true, SeriesColor::kEvent, false},
                                                    {"plain ants", "plain_ant_colony", true, SeriesColor::kOdometry},
                                                    {"two swarms", "two_swarms", true, SeriesColor::kRanges},
                                                    {"Q-learning", "q_learning", true, SeriesColor::kAlarm},
                                                    {"Theta*", "theta_star", false, SeriesColor::kEvent},
                                                    {"Dijkstra", "dijkstra", false, SeriesColor::kConfidence},
                                                    {"A*", "astar", false, SeriesColor::kTruth},
                                                    {"any-angle optimum", "any_angle_optimum", false, SeriesColor::kBound}}};
constexpr std::size_t kAstar = 7, kOptimum = 8;

const std::vector<studies::StudyFigure> kPlannerFigures = {{.name = "longer than A*", .unit = "%", .is_compared = true},
                                           {.name = "iterations to 1 % of its final value", .unit = "", .is_compared = true},
                                           {.name = "iterations to A* + 3 %", .unit = ""},
                                           {.name = "found", .unit = "%"},
                                           {.name = "over any-angle", .unit = "%"},
                                           {.name = "clearance", .unit = "cells"},
                                           {.name = "steps", .unit = "1000"},
                                           {.name = "time", .unit = "ms", .is_of_the_clock = true}};

struct Planned {
  plan::Route route;
  double seconds = 0.0;  ///< processor time
};

Planned plan_by(const PlannerMethod& method, const PlannerProblem& problem, std::uint64_t seed) {
  plan::RoutePlannerSettings settings{.max_steps_millions = kMaxStepsMillions};
  settings.improved_colony.tightens = method.tightens;
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
  return kNoPlannerFigure;
}

std::vector<std::vector<double>> flatten_metrics(const std::array<Planned, kPlannerMethods.size()>& all) {
  std::vector<std::vector<double>> figures;
  const double astar = all[kAstar].route.length, optimum = all[kOptimum].route.length;
  for (std::size_t m = 0; m < kPlannerMethods.size(); ++m) {
    const plan::Route& route = all[m].route;
    const bool is_found = route.status == plan::PlanStatus::kFound, iterates = kPlannerMethods[m].iterates && is_found;
    figures.push_back({is_found ? 100.0 * (route.length / astar - 1.0) : kNoPlannerFigure,
                       iterates ? plan::iterations_to_within(route.history, 0.01) : kNoPlannerFigure,
                       iterates ? iterations_to_length(route.history, 1.03 * astar) : kNoPlannerFigure,
                       is_found ? 100.0 : 0.0,
                       is_found ? 100.0 * (route.length / optimum - 1.0) : kNoPlannerFigure,
                       is_found ? route.clearance : kNoPlannerFigure,
                       1e-3 * static_cast<double>(route.num_expanded),
                       1e3 * all[m].seconds});
  }
  return figures;
}

std::array<Planned, kPlannerMethods.size()> plan_all(const PlannerProblem& problem, std::uint64_t seed) {
  std::array<Planned, kPlannerMethods.size()> all;
  for (std::size_t m = 0; m < kPlannerMethods.size(); ++m) all[m] = plan_by(kPlannerMethods[m], problem, seed);
  return all;
}

studies::StudySample run_planners(const std::vector<PlannerWorld>& worlds, std::uint64_t seed) {
  studies::StudySample sample;
  for (const PlannerWorld& world : worlds) {
    for (std::vector<double>& figures : flatten_metrics(plan_all(world.problem(seed), seed))) sample.push_back(std::move(figures));
  }
  return sample;
}

/// Figure 1: excess of the best route so far over A*'s length, in the first two hundred iterations.
report::LinePlot convergence(const std::array<Planned, kPlannerMethods.size()>& all, const std::string& world) {
  constexpr std::size_t kShown = 200;
  constexpr double kMost = 25.0;
  report::LinePlot plot{.title = fmt::format("Longer than A*, best so far: {}", world), .unit = "%", .axis = {.label = "iteration", .max = kShown}, .max = kMost, .curves = {}, .marks = {}, .spans = {}};
  for (std::size_t m = 0; m < kPlannerMethods.size(); ++m) {
    if (!kPlannerMethods[m].iterates) continue;
    report::Curve curve{.name = kPlannerMethods[m].title, .color = kPlannerMethods[m].color, .is_dashed = false, .points = {}};
    for (std::size_t i = 0; i < kShown; ++i) {
      const std::vector<double>& history = all[m].route.history;
      const double excess = i < history.size() ? 100.0 * (history[i] / all[kAstar].route.length - 1.0) : kNoPlannerFigure;
      if (excess <= kMost) curve.points.emplace_back(static_cast<double>(i + 1), excess);
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
    block.paths.push_back({kPlannerMethods[m].title, kPlannerMethods[m].color, {plan::to_metres(grid, all[m].route.points)}});
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
  studies::Study study{.name = "planners",
              .title = "Planners of routes: ants of [Li22] and the others",
              .source = "[Li22], figures 1 to 4, which carry no numbers that can be read",
              .conditions = "Every seed draws each grid anew, or the ends on a world's map (its surfaces at the lidar's height in cells of 0.2 m, inflated by its robot's footprint). "
                            "Eight neighbours, no corner cut; lengths in cells. Ants: 80 in 200 iterations; swarms: two of 40 in 200; Q-learning: 5000 episodes; none beyond 50 million "
                            "steps. The improved ants are the paper's, whose routes are pulled tight before they count (ours). Over any-angle: than the shortest way there is, which touches corners. Default settings throughout, chosen on generated grids of other seeds. A planner that is improved later and one that is done at once both need few iterations to "
                            "1 % of their own final value: iterations to A*'s length and 3 %, over the seeds that get there, tell them apart. Q-learning and swarms are of the kinds that the paper "
                            "compares with; their papers are not known to us.",
              .default_seeds = 30,
              .compared_with = "the improved ants",
              .figures = kPlannerFigures};
  for (const PlannerWorld& world : worlds) {
    const std::size_t reference = study.variants.size();
    for (const PlannerMethod& method : kPlannerMethods) study.variants.push_back({.world = world.name, .method = method.title, .particles = 0, .reference = reference});
  }
  study.illustrate = [worlds](std::uint64_t seed) { return illustrate_planners(worlds, seed); };
  study.run = [worlds = std::move(worlds)](std::uint64_t seed) { return run_planners(worlds, seed); };
  return study;
}

}  // namespace patrol::app
