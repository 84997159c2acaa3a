#pragma once

#include <cstdint>
#include <string>

#include "plan/routes/route_planner.h"

namespace patrol::app {

/// Path planning problem between two connected cells.
struct PlannerProblem {
  Grid<plan::Cost> costs;  ///< free and lethal cells
  Cell start, goal;
};

/// Problem on a generated grid "random", "rooms" or "maze" (plan/routes/generated_grids.h), from corner to corner. The
/// corridors of a maze are two cells wide.
PlannerProblem generated_problem(const std::string& kind, int size_cells, std::uint64_t seed);

/// Problem on the reference map of "street", "tunnel" or "substation": the surfaces visible to the robot's lidar, in
/// cells of 0.2 m, inflated by the robot's footprint as in a run, with the keep-out lines. The ends are sampled from
/// the cells reachable from the robot's start, at least a third of the map's diagonal apart.
PlannerProblem world_problem(const std::string& world, std::uint64_t seed);

}  // namespace patrol::app
