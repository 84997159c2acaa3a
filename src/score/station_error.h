#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "core/frames.h"
#include "core/grid.h"
#include "core/messages.h"
#include "core/route.h"
#include "core/site/map_in_site.h"
#include "core/trajectory.h"
#include "score/distance_field.h"

namespace patrol::score {

/// Accuracy at one station of the route.
struct StationError {
  std::string name;
  bool is_reported = false;                ///< whether the robot reported an arrival
  bool is_reached = false;                 ///< whether a reported arrival is true (arrival_score.h)
  double position_error_m = 0.0;           ///< error of the estimated pose in site at the time of the arrival event
  double heading_error_deg = 0.0;          ///< absolute value, at the arrival event
  double goal_position_error_m = 0.0;      ///< distance of the true position from the surveyed one
  std::optional<double> map_error_m;       ///< displacement of the station's target in the built map
  std::optional<double> site_map_error_m;  ///< displacement with the map placed in site by the robot's registration
};

/// Displacement of a station's target in the built map, m. The occupied cells within `radius_m` of the target are
/// registered to the surfaces of the reference by a rigid motion (Gauss-Newton on their distance field, robust loss).
/// The displacement is the distance by which this motion moves the target.
///
/// Gauss-Newton starts twice: from the identity, and from the best of a grid of motions up to 3 m along either axis and
/// 4 degrees. The second result counts only where it fits clearly better, so larger errors are found up to that limit.
/// Degenerate directions (along a single straight wall) are not moved. Returns none when there are too few occupied
/// cells.
std::optional<double> map_displacement_m(const OccupancyGrid& built, const Pose2& T_world_map,
                                         const DistanceField& reference, const Eigen::Vector2d& p_world_target,
                                         double radius_m = 6.0);

/// Returns the pose of the built map in world for which its occupied cells fit the reference best: Gauss-Newton as for
/// map_displacement_m over the whole map, from each of the given poses. Degenerate directions (along a tunnel without
/// features) are not moved. Returns the first pose when there are too few occupied cells. Precondition: there is one.
Pose2 fit_map_to_reference(const OccupancyGrid& built, std::span<const Pose2> T_world_map,
                           const DistanceField& reference);

/// One entry per station in the order of the route, by its last true arrival, or else by its last reported one.
/// `route_in_world` is the survey, the ground truth of the stations. Precondition: `T_world_body` is not empty.
/// `T_world_map`: true pose of the built map; `map`: its pose in site as the robot knows it.
std::vector<StationError> station_errors(const Route& route_in_world, const std::vector<Event>& events,
                                         const Pose2& T_world_map, const MapInSite& map, const Trajectory& T_world_body,
                                         const OccupancyGrid& built, const DistanceField& reference);

}  // namespace patrol::score
