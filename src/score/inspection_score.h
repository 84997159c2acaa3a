#pragma once

#include <Eigen/Core>

#include <string>
#include <vector>

#include "core/frames.h"
#include "core/messages.h"

namespace patrol::score {

/// A leak that was really there.
struct TrueLeak {
  std::string name;
  Eigen::Vector2d p_world_m = Eigen::Vector2d::Zero();
};

/// An alarm of the robot beside the leak it is about.
struct Finding {
  std::string station;
  double column_ppm_m = 0.0;
  Eigen::Vector2d p_world_m = Eigen::Vector2d::Zero();  ///< where the robot reported it
  std::string leak;      ///< empty: a false alarm
  double error_m = 0.0;  ///< from the leak
};

struct InspectionScore {
  int leaks = 0;
  int leaks_found = 0;
  int false_alarms = 0;
  std::vector<Finding> findings;
};

/// An alarm is about the nearest leak within `max_distance_m`; one with no leak there is false.
InspectionScore inspection_score(const std::vector<Event>& events, const Pose2& T_world_map,
                                 const std::vector<TrueLeak>& leaks, double max_distance_m = 2.0);

}  // namespace patrol::score
