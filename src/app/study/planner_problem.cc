#include "app/study/planner_problem.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>
#include <vector>

#include "app/scenario/scenario.h"
#include "app/scoring/world_surfaces.h"
#include "core/error.h"
#include "core/random.h"
#include "plan/routes/generated_grids.h"
#include "plan/routes/global_planner.h"

namespace patrol::app {
namespace {

constexpr double kProblemCell_m = 0.05;
constexpr double kPlanningCell_m = 0.2;
constexpr double kFarShare = 1.0 / 3.0;  ///< fraction of the diagonal
constexpr std::uint64_t kMaxDraws = 1000;

constexpr std::array<std::pair<const char*, const char*>, 3> kScenarios = {
    {{"street", "worlds/street/scenarios/patrol.yaml"}, {"tunnel", "worlds/tunnel/scenarios/navigate.yaml"}, {"substation", "worlds/substation/scenarios/mapping.yaml"}}};

struct DrivableWorld {
  Grid<plan::Cost> costs;
  std::vector<Cell> reachable;  ///< from the robot's start
};

DrivableWorld load_world(const std::string& name) {
  const auto* const known = std::find_if(kScenarios.begin(), kScenarios.end(), [&](const auto& scenario) { return name == scenario.first; });
  if (known == kScenarios.end()) throw InputError("there is no world '" + name + "' to plan in");
  const std::filesystem::path root = find_data_root("");
  const Scenario scenario = load_scenario(root / known->second, {});
  const ScenarioFiles files = load_scenario_files(scenario, root);
  plan::CostmapSettings settings = scenario.stack.navigation.costmap;
  settings.resolution_m = kPlanningCell_m;
  settings.allow_unknown = false;
  plan::Costmap costmap(settings, plan::Footprint(files.robot.footprint_m, scenario.stack.navigation.footprint_rows), files.route.keep_out_lines);
  costmap.set_map(world_surfaces(files, kProblemCell_m).surfaces);
  DrivableWorld world{.costs = costmap.cost(), .reachable = {}};
  for (plan::Cost& cost : world.costs.values()) cost = cost == plan::kLethalCost ? plan::kLethalCost : plan::kFreeCost;
  const std::optional<Cell> start = plan::nearest_passable(world.costs, files.T_site_start.position(), 1.0);
  if (!start) throw InputError("the robot of the world '" + name + "' starts in an obstacle");
  world.reachable = plan::reachable_cells(world.costs, *start);
  return world;
}

}  // namespace

PlannerProblem generated_problem(const std::string& kind, int size_cells, std::uint64_t seed) {
  plan::GeneratedGrid grid = plan::generate_grid({.kind = kind, .size_cells = size_cells, .corridor_cells = 2}, seed);
  return {.costs = std::move(grid.costs), .start = grid.start, .goal = grid.goal};
}

PlannerProblem world_problem(const std::string& world, std::uint64_t seed) {
  DrivableWorld drivable = load_world(world);
  const GridGeometry& grid = drivable.costs.geometry();
  const double far = kFarShare * std::hypot(grid.width, grid.height);
  RandomSequence random(RandomStream(seed, "study/planners/" + world), 0);
  for (std::uint64_t draw = 0; draw < kMaxDraws; ++draw) {
    const Cell start = drivable.reachable[random.index(drivable.reachable.size())], goal = drivable.reachable[random.index(drivable.reachable.size())];
    if (std::hypot(goal.col - start.col, goal.row - start.row) < far) continue;
    return {.costs = std::move(drivable.costs), .start = start, .goal = goal};
  }
  throw InputError("no two places of the world '" + world + "' are far enough apart");
}

}  // namespace patrol::app
