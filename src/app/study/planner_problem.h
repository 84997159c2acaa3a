#pragma once

#include <cstdint>
#include <string>

#include "plan/routes/route_planner.h"

namespace patrol::app {

/// From a cell to a cell, between which there is a way.
struct PlannerProblem {
  Grid<plan::Cost> costs;  ///< free and lethal cells
  Cell start, goal;
};

/// "random", "rooms" or "maze" (plan/routes/generated_grids.h), from corner to corner; the corridors of a maze are two cells wide.
PlannerProblem generated_problem(const std::string& kind, int size_cells, std::uint64_t seed);

/// The reference map of "street", "tunnel" or "substation": what its robot's lidar would see of the world, in cells of 0.2 m, inflated by the robot's
/// footprint as when it drives, with the lines that it must not cross. The ends are drawn from what can be reached from the robot's start,
/// at least a third of the map's diagonal apart.
PlannerProblem world_problem(const std::string& world, std::uint64_t seed);

}  // namespace patrol::app
