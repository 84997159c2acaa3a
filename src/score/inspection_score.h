#pragma once

#include <string>
#include <vector>

#include <Eigen/Core>

#include "core/frames.h"
#include "core/messages.h"
#include "core/site/map_in_site.h"

namespace patrol::score {

/// Leak of the simulated world.
struct LeakGroundTruth {
  std::string name;
  Eigen::Vector2d p_world_m = Eigen::Vector2d::Zero();
};

/// Gas alarm of the robot with the leak that it is assigned to.
struct ScoredAlarm {
  std::string station;
  double column_ppm_m = 0.0;                            ///< measured methane column
  Eigen::Vector2d p_world_m = Eigen::Vector2d::Zero();  ///< position reported by the robot
  std::string leak;                                     ///< name of the leak; empty for a false alarm
  double error_m = 0.0;                                 ///< distance from the leak
};

/// Number of leaks found and of false alarms, with all findings.
struct InspectionScore {
  int leaks = 0;
  int leaks_found = 0;
  int false_alarms = 0;
  std::vector<ScoredAlarm> findings;
};

/// Assigns each alarm, placed in site as the robot places it, to the nearest leak within `max_distance_m`. An alarm
/// with no leak in this radius is a false alarm.
InspectionScore inspection_score(const std::vector<Event>& events, const MapInSite& map,
                                 const std::vector<LeakGroundTruth>& leaks, double max_distance_m = 2.0);

}  // namespace patrol::score
