#pragma once

#include <optional>
#include <vector>

#include <Eigen/Core>
#include <mujoco/mujoco.h>

#include "core/grid.h"

namespace patrol::importer {

/// Settings of `plan_of`.
struct SitePlanSettings {
  double cell_m = 0.05;          ///< cells; twice as large for each factor of four above `max_cells`
  double max_cells = 1.5e6;      ///< maximum number of cells
  double height_m = 1.5;         ///< height of the space that a robot needs above the ground
  double max_step_m = 0.1;       ///< maximum difference of the ground's heights of neighboring cells
  double min_obstacle_m = 0.05;  ///< minimum height of an obstacle above the ground
  double margin_m = 2.0;         ///< width of the plan beyond the surfaces that have an end, start and stations
  double max_outside_m = 50.0;   ///< start and stations farther outside of the surfaces do not extend the plan
  double clearance_m = 0.5;      ///< clearance of the robot; ground inside of walls needs kMinEnclosed_m2 with it
};

/// Floor plan of a site.
struct SitePlan {
  OccupancyGrid map;
  /// Whether the map is of ground inside of walls: the ground outside is larger with its margin only.
  bool is_enclosed = false;
  /// Whether the map is of ground outside of walls: that inside of them is too narrow for the robot.
  bool is_too_narrow = false;
};

/// Returns the floor plan of a site by what its lidars see: cells of the connected ground are free, cells with a
/// surface up to `height_m` above it are occupied, also of walls that are thinner than a cell; all others are unknown.
/// The ground is the lowest surface that faces up with the height above it; it is flooded from the cell at `p_start_m`,
/// or everywhere. Then it is the region of `choose_region`. Ground inside of solids is left out, and so is ground
/// inside of walls without an interior. The plan contains the start and `stations_m`, points in site. Throws InputError
/// if there is no ground, or if the start is inside of a solid.
SitePlan plan_of(const mjModel& site, const std::optional<Eigen::Vector2d>& p_start_m,
                 const std::vector<Eigen::Vector2d>& stations_m = {}, const SitePlanSettings& settings = {});

/// Throws InputError if a start on the lowest floor is inside of a solid with contact.
void refuse_start_in_solid(const mjModel& site, const Eigen::Vector2d& p_start_m,
                           const SitePlanSettings& settings = {});

}  // namespace patrol::importer
