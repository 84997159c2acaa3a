#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include <Eigen/Core>

#include "core/messages.h"
#include "core/trajectory.h"

/// Comparison of the arrivals that a robot reports with its true position.
namespace patrol::score {

/// Distance from a goal up to which a reported arrival is true, in addition to the accuracy of the goal, m. Positions
/// of correct arrivals are up to 0.32 m off, from drift of the map and errors of the motion controller. An arrival
/// outside of this distance is at another place.
inline constexpr double kArrivalTolerance_m = 1.0;

/// Station, goal or dock of a mission.
struct MissionGoal {
  std::string name;  ///< subject of the event of an arrival; empty: any subject
  EventKind arrival = EventKind::kStationReached;
  Eigen::Vector2d p_world_m = Eigen::Vector2d::Zero();
  double accuracy_m = 0.0;   ///< position tolerance of the goal
  bool is_required = false;  ///< whether the mission is not completed without an arrival
};

struct ArrivalScore {
  std::size_t num_false = 0;     ///< reported arrivals outside of the tolerance
  bool is_contradicted = false;  ///< whether a goal that is required, or that the robot reported, has no true arrival
};

/// Returns the true pose at the stamp of an event. Before the ground truth it is the first pose, after it the last one.
/// Precondition: `T_world_body` is not empty.
Pose2 true_pose_of(const Event& event, const Trajectory& T_world_body);

/// Returns whether an arrival with this true position is true.
bool is_arrival(const Eigen::Vector2d& p_world_body_m, const Eigen::Vector2d& p_world_goal_m, double accuracy_m);

/// Compares the reported arrivals with the truth. A goal that the robot saved during the run is where it truly was at
/// that time, and replaces a given one with its name. Precondition: `T_world_body` is not empty.
ArrivalScore arrival_score(const std::vector<Event>& events, std::vector<MissionGoal> goals,
                           const Trajectory& T_world_body);

}  // namespace patrol::score
