#pragma once

#include <optional>
#include <string>
#include <vector>

#include "core/messages.h"
#include "core/route.h"
#include "core/trajectory.h"

namespace patrol::score {

/// Error of the robot's true pose, at the time of its arrival event, relative to the goal pose.
struct Arrival {
  int navigation = 0;  ///< number of the navigation, from 1
  double position_error_m = 0.0;
  double heading_error_deg = 0.0;  ///< absolute value
};

/// All true arrivals at one goal (arrival_score.h). Reports that the truth contradicts are not arrivals.
struct GoalError {
  std::string name;
  std::vector<Arrival> arrivals;
  int num_failed = 0;  ///< number of failed navigations

  std::vector<double> position_errors_m() const;
  std::vector<double> heading_errors_deg() const;
};

/// Repeatability as in [Liu21, tab. 2]. A goal saved during teleoperation is compared with the robot's true pose at the
/// time of saving, so the error contains map, localization and control. `given` goals (in map) are transformed to world
/// by `T_world_map`. Precondition: `T_world_body` is not empty.
std::vector<GoalError> goal_errors(const std::vector<Event>& events, const std::vector<SavedGoal>& given,
                                   const Pose2& T_world_map, const Trajectory& T_world_body);

/// Errors of all dockings relative to the surveyed docked pose. Precondition: `T_world_body` is not empty.
GoalError docking_error(const std::vector<Event>& events, const Pose2& T_world_docked, const Trajectory& T_world_body);

}  // namespace patrol::score
