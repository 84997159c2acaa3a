#include "app/study/planner_problem.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>
#include <vector>

#include "app/scenario/data_folders.h"
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
constexpr double kMinDistanceFraction = 1.0 / 3.0;  ///< fraction of the diagonal
constexpr std::uint64_t kMaxAttempts = 1000;

constexpr std::array<std::pair<const char*, const char*>, 3> kScenarios = {
    {{"street", "worlds/street/scenarios/patrol.yaml"},
     {"tunnel", "worlds/tunnel/scenarios/navigate.yaml"},
     {"substation", "worlds/substation/scenarios/mapping.yaml"}}};

struct DrivableWorld {
  Grid<plan::Cost> costs;
  std::vector<Cell> reachable;  ///< from the robot's start
};

DrivableWorld load_world(const std::string& name) {
  const auto* const found =
      std::find_if(kScenarios.begin(), kScenarios.end(), [&](const auto& scenario) { return name == scenario.first; });
  if (found == kScenarios.end()) throw InputError("unknown world '" + name + "' (known: street, tunnel, substation)");
  const std::filesystem::path root = find_data_root("");
  const Scenario scenario = load_scenario(root / found->second, {});
  const ScenarioFiles files = load_scenario_files(scenario, root);
  plan::CostmapSettings settings = scenario.stack.navigation.costmap;
  settings.resolution_m = kPlanningCell_m;
  settings.allow_unknown = false;
  plan::Costmap costmap(settings, plan::Footprint(files.robot.footprint_m, scenario.stack.navigation.footprint_rows),
                        files.route.keep_out_lines);
  costmap.set_map(world_surfaces(files, kProblemCell_m).surfaces);
  DrivableWorld world{.costs = costmap.cost(), .reachable = {}};
  for (plan::Cost& cost : world.costs.values()) cost = cost == plan::kLethalCost ? plan::kLethalCost : plan::kFreeCost;
  const std::optional<Cell> start = plan::nearest_passable(world.costs, files.T_site_start.position(), 1.0);
  if (!start) throw InputError("world '" + name + "': the robot starts in collision");
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
  const double far = kMinDistanceFraction * std::hypot(grid.width, grid.height);
  RandomSequence random(RandomStream(seed, "study/planners/" + world), 0);
  for (std::uint64_t attempt = 0; attempt < kMaxAttempts; ++attempt) {
    const Cell start = drivable.reachable[random.index(drivable.reachable.size())],
               goal = drivable.reachable[random.index(drivable.reachable.size())];
    if (std::hypot(goal.col - start.col, goal.row - start.row) < far) continue;
    return {.costs = std::move(drivable.costs), .start = start, .goal = goal};
  }
  throw InputError("world '" + world + "': no two positions are far enough apart");
}

}  // namespace patrol::app
