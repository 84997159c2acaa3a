#include "app/plan/problem_file.h"

#include <map>
#include <memory>
#include <utility>

#include <fmt/format.h>

#include "app/common/process_cost.h"
#include "app/common/progress_bar.h"
#include "app/plan/plan_grid.h"
#include "app/plan/route_check.h"
#include "app/plan/route_metrics.h"
#include "core/error.h"

namespace patrol::app {
namespace {

bool is_any_angle(const std::string& planner) { return planner == "theta_star" || planner == "visibility_graph"; }

/// Cost grids of the maps that a file's problems name, for starts on land and in water.
class Grids {
 public:
  explicit Grids(std::filesystem::path file) : file_(std::move(file)) {}

  const Grid<plan::Cost>& of(const io::MovingAiProblem& problem) {
    auto map = maps_.find(problem.map);
    if (map == maps_.end()) map = maps_.emplace(problem.map, io::load_moving_ai_map(find_map(file_, problem))).first;
    const GridGeometry& size = map->second.terrain.geometry();
    if (size.width != problem.width || size.height != problem.height) {
      throw input_error(file_.string(), problem.line,
                        fmt::format("{}: has {} x {} cells, the problem's map {} x {}", problem.map, size.width,
                                    size.height, problem.width, problem.height));
    }
    const bool swims = map->second.terrain.at(problem.start) == 'W';
    const auto key = std::pair(problem.map, swims);
    auto grid = grids_.find(key);
    if (grid == grids_.end())
      grid = grids_.emplace(key, make_costs(io::to_occupancy(map->second, problem.start), {}, {})).first;
    return grid->second;
  }

 private:
  std::filesystem::path file_;
  std::map<std::string, io::MovingAiMap> maps_;
  std::map<std::pair<std::string, bool>, Grid<plan::Cost>> grids_;
};

std::optional<std::string> failure_of(const SolvedProblem& solved, const plan::Route& route,
                                      const Grid<plan::Cost>& costs, const std::string& planner) {
  const io::MovingAiProblem& problem = solved.problem;
  if (solved.status == plan::PlanStatus::kNotFound) return "no route found";
  if (!solved.is_found()) return "no route found, but the file states a length";
  if (const auto fault = validate_route(costs, route, problem.start, problem.goal, planner == "visibility_graph"))
    return "the route " + *fault;
  if (must_agree(planner) && !solved.agrees())
    return fmt::format("is {:.6f} cells long, published {:.6f}", solved.length, problem.optimal_length);
  if (is_any_angle(planner) && solved.length > problem.optimal_length + solved.published_tolerance()) {
    return fmt::format("is {:.6f} cells long, more than {:.6f} over eight neighbors", solved.length,
                       problem.optimal_length);
  }
  return std::nullopt;
}

}  // namespace

bool must_agree(const std::string& planner) { return planner == "astar" || planner == "dijkstra"; }

std::filesystem::path find_map(const std::filesystem::path& file, const io::MovingAiProblem& problem) {
  const std::filesystem::path as_written = file.parent_path() / problem.map,
                              in_same_folder = file.parent_path() / std::filesystem::path(problem.map).filename();
  for (const std::filesystem::path& map : {as_written, in_same_folder}) {
    std::error_code ignored;  // an invalid file name
    if (std::filesystem::is_regular_file(map, ignored)) return map;
  }
  throw input_error(
      file.string(), problem.line,
      fmt::format("{}: neither {} nor {} found", problem.map, as_written.string(), in_same_folder.string()));
}

std::optional<std::vector<SolvedProblem>> solve_problems(const std::filesystem::path& file,
                                                         const PlanSettings& settings) {
  const std::vector<io::MovingAiProblem> problems = io::load_moving_ai_problems(file);
  const std::unique_ptr<plan::RoutePlanner> planner =
      plan::make_route_planner(settings.planner, settings.routes, settings.seed);
  Grids grids(file);
  InterruptGuard guard;
  ProgressBar bar;
  std::vector<SolvedProblem> all;
  for (const io::MovingAiProblem& problem : problems) {
    const Grid<plan::Cost>& costs = grids.of(problem);
    const double processor_s = process_seconds();
    const plan::Route route = planner->plan(costs, problem.start, problem.goal);
    SolvedProblem solved{.problem = problem,
                         .status = route.status,
                         .length = route.length,
                         .num_turns = count_turns(route.points),
                         .num_expanded = route.num_expanded,
                         .processor_s = process_seconds() - processor_s};
    solved.failure = failure_of(solved, route, costs, settings.planner);
    all.push_back(std::move(solved));
    if (guard.is_interrupted()) return std::nullopt;
    bar.show(fmt::format("{}  {} of {} problems", file.filename().string(), all.size(), problems.size()),
             static_cast<double>(all.size()) / static_cast<double>(problems.size()));
  }
  return all;
}

}  // namespace patrol::app
