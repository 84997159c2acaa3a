#pragma once

#include <optional>
#include <string>
#include <vector>

#include "core/frames.h"
#include "core/grid.h"
#include "core/messages.h"
#include "core/route.h"
#include "core/trajectory.h"
#include "score/visibility.h"

namespace patrol::score {

/// How well one station of the route was found.
struct StationError {
  std::string name;
  bool is_reached = false;
  double position_error_m = 0.0;   ///< of the robot's own pose when it said that it had arrived
  double heading_error_deg = 0.0;
  double stand_error_m = 0.0;      ///< where it really stood, from where the survey wants it
  std::optional<double> map_error_m;  ///< how far the built map has the station's target from its true place
};

/// Displacement of a station's target in the built map, m. The occupied cells within `radius_m` of the target are registered to the
/// reference by a rigid motion (Gauss-Newton on the reference's distance field, robust); the displacement is how far the motion
/// moves the target. Gauss-Newton starts twice: from the map as it lies, and from the best of a grid of motions up to 3 m along
/// either axis and 4 degrees. The second result counts where it fits clearly better: larger errors are found up to that limit.
/// Directions that the surroundings do not show (along a single straight wall) are not moved. None if there is too little to fit.
std::optional<double> map_displacement_m(const OccupancyGrid& built, const Pose2& T_world_map,
                                         const ReferenceMap& reference, const Eigen::Vector2d& p_world_target,
                                         double radius_m = 6.0);

/// One entry per station, in the route's order. `route_in_world`: the survey, which is true.
std::vector<StationError> station_errors(const Route& route_in_world, const std::vector<Event>& events,
                                         const Pose2& T_world_map, const Trajectory& T_world_body,
                                         const OccupancyGrid& built, const ReferenceMap& reference);

}  // namespace patrol::score
