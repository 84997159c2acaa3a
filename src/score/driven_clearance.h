#pragma once

#include <Eigen/Core>

#include <cstddef>
#include <vector>

#include "core/grid.h"
#include "core/trajectory.h"

namespace patrol::score {

/// Free room about a robot's outline along its way.
struct DrivenClearance {
  double mean_m = 0.0;
  double p05_m = 0.0;  ///< less than this at one place of twenty
  double min_m = 0.0;  ///< 0 where it touched
  std::size_t places = 0;
};

inline constexpr double kMaxClearance_m = 3.0;  ///< more does not count as more

/// From the outline (convex, counter-clockwise, in level) to the centre of the nearest occupied cell of the map, in world, at places of the way that lie
/// `spacing_m` apart. Nothing is known of what moves. All zero of a way or an outline that is none.
DrivenClearance driven_clearance(const Trajectory& T_world_body, const std::vector<Eigen::Vector2d>& footprint_m, const OccupancyGrid& map_in_world,
                                 double spacing_m = 0.1);

}  // namespace patrol::score
