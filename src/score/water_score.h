#pragma once

#include <optional>
#include <string>
#include <vector>

#include <Eigen/Core>

#include "core/inspection_result.h"
#include "core/site/map_in_site.h"
#include "core/trajectory.h"

namespace patrol::score {

/// Water body of the simulated world.
struct WaterGroundTruth {
  Eigen::Vector3d p_world_m = Eigen::Vector3d::Zero();
  double radius_m = 0.0;
};

/// Water body reported by the robot with the true body that it is assigned to.
struct WaterFinding {
  std::string station;
  std::optional<std::size_t> body;  ///< index of the true body; none for a false alarm, and the fields below are unset
  double position_error_m = 0.0;    ///< distance in space (3D)
  double ahead_error_m = 0.0;  ///< error along the line from the antenna to the body; positive: reported too far away
  double radius_error_m = 0.0;
  bool distance_in_interval = false;   ///< the reported distance interval contains the true distance
  bool radius_in_interval = false;     ///< the reported radius interval contains the true radius
  bool position_in_ellipsoid = false;  ///< the true position lies within the 95 % ellipsoid of the reported one
};

/// Number of bodies found and missed and of false alarms, with all findings.
struct WaterScore {
  int stations = 0;  ///< stations with soundings
  int bodies = 0;
  int found = 0;  ///< bodies with at least one finding
  int missed = 0;
  int false_alarms = 0;
  std::vector<WaterFinding> findings;
};

/// Assigns each finding to the nearest true body within `max_distance_m`. A finding with no body in this radius is a
/// false alarm. Findings are placed in site as the robot places them in the plane, and by the robot's true height,
/// which is not estimated. Distances start at the true antenna, `p_body_antenna` in body. Without any sounding, no body
/// counts as missed.
WaterScore water_score(const std::vector<WaterResult>& results, const std::vector<WaterGroundTruth>& bodies,
                       const MapInSite& map, const Trajectory& T_world_body, const Eigen::Vector3d& p_body_antenna,
                       double max_distance_m = 6.0);

}  // namespace patrol::score
