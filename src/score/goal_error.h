#pragma once

#include <optional>
#include <string>
#include <vector>

#include "core/messages.h"
#include "core/route.h"
#include "core/trajectory.h"

namespace patrol::score {

/// Where the robot really stood when it said that it was there, from where it should have stood.
struct Arrival {
  int navigation = 0;  ///< 1 is the first
  double position_error_m = 0.0;
  double heading_error_deg = 0.0;  ///< absolute
};

/// All arrivals at one place.
struct GoalError {
  std::string name;
  std::vector<Arrival> arrivals;
  int num_failed = 0;

  std::vector<double> position_errors_m() const;
  std::vector<double> heading_errors_deg() const;
};

/// Repeatability as paper 004, table 2 has it. A goal that was marked by driving there shall be met where the robot truly stood at the
/// mark: map, localisation and control all count. `given` goals (in map) shall be met where the survey's start puts them.
std::vector<GoalError> goal_errors(const std::vector<Event>& events, const std::vector<MarkedGoal>& given,
                                   const Pose2& T_world_map, const Trajectory& T_world_body);

/// Every docking, against the docked pose of the survey.
GoalError docking_error(const std::vector<Event>& events, const Pose2& T_world_docked, const Trajectory& T_world_body);

}  // namespace patrol::score
