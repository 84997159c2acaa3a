#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include <Eigen/Core>

#include "core/grid.h"
#include "core/trajectory.h"

namespace patrol::score {

/// Clearance between the robot's outline and the nearest obstacle along the driven path.
struct DrivenClearance {
  double mean_m = 0.0;
  double p05_m = 0.0;                    ///< 5th percentile
  double min_m = 0.0;                    ///< minimum; 0 at a collision
  std::size_t num_positions = 0;         ///< number of evaluated path positions
  std::optional<double> keep_out_min_m;  ///< minimum distance from the keep-out lines; 0 if the outline crossed one
};

inline constexpr double kMaxClearance_m = 3.0;  ///< upper limit; larger clearances count as this value

/// Distance from the outline to the center of the nearest occupied cell, at path positions at least `spacing_m` apart.
/// The outline is convex and counterclockwise, in the level body frame. Moving obstacles are not considered. Returns
/// zeros for an empty path or an outline with fewer than three corners.
DrivenClearance driven_clearance(const Trajectory& T_world_body, const std::vector<Eigen::Vector2d>& footprint_m,
                                 const OccupancyGrid& map_in_world,
                                 const std::vector<std::vector<Eigen::Vector2d>>& keep_out_lines_in_world = {},
                                 double spacing_m = 0.1);

}  // namespace patrol::score
