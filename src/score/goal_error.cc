#include "score/goal_error.h"

#include <cmath>
#include <map>

#include "core/geometry/angles.h"
#include "score/arrival_score.h"

namespace patrol::score {
namespace {

/// True pose of a goal, with its position tolerance.
struct TrueGoal {
  Pose2 T_world_goal;
  double accuracy_m = 0.0;
};

/// Adds the arrival that an event reports, if it is true.
void add_arrival(const Event& event, const TrueGoal& goal, const Trajectory& T_world_body, GoalError& error) {
  const Pose2 T_world_truth = true_pose_of(event, T_world_body);
  const Pose2& T_world_goal = goal.T_world_goal;
  if (!is_arrival(T_world_truth.position(), T_world_goal.position(), goal.accuracy_m)) return;
  error.arrivals.push_back({.navigation = static_cast<int>(event.value),
                            .position_error_m = (T_world_truth.position() - T_world_goal.position()).norm(),
                            .heading_error_deg = to_deg(std::abs(wrap_angle(T_world_truth.yaw - T_world_goal.yaw)))});
}

/// True goals by name.
std::map<std::string, TrueGoal> true_goals(const std::vector<Event>& events, const std::vector<SavedGoal>& given,
                                           const Pose2& T_world_map, const Trajectory& T_world_body) {
  std::map<std::string, TrueGoal> goals;
  for (const SavedGoal& goal : given) goals[goal.name()] = {T_world_map * goal.T_map_body, goal.accuracy_m};
  for (const Event& event : events) {
    if (event.kind == EventKind::kGoalSaved)
      goals[event.subject] = {true_pose_of(event, T_world_body), SavedGoal{}.accuracy_m};
  }
  return goals;
}

}  // namespace

std::vector<double> GoalError::position_errors_m() const {
  std::vector<double> errors;
  for (const Arrival& one : arrivals) errors.push_back(one.position_error_m);
  return errors;
}

std::vector<double> GoalError::heading_errors_deg() const {
  std::vector<double> errors;
  for (const Arrival& one : arrivals) errors.push_back(one.heading_error_deg);
  return errors;
}

std::vector<GoalError> goal_errors(const std::vector<Event>& events, const std::vector<SavedGoal>& given,
                                   const Pose2& T_world_map, const Trajectory& T_world_body) {
  std::vector<GoalError> errors;
  for (const auto& [name, goal] : true_goals(events, given, T_world_map, T_world_body)) {
    GoalError error{.name = name, .arrivals = {}};
    for (const Event& event : events) {
      if (event.subject != name) continue;
      if (event.kind == EventKind::kGoalFailed) ++error.num_failed;
      if (event.kind == EventKind::kGoalReached) add_arrival(event, goal, T_world_body, error);
    }
    errors.push_back(std::move(error));
  }
  return errors;
}

GoalError docking_error(const std::vector<Event>& events, const Pose2& T_world_docked, const Trajectory& T_world_body) {
  GoalError error{.name = "dock", .arrivals = {}};
  for (const Event& event : events) {
    if (event.kind == EventKind::kDockFailed) ++error.num_failed;
    if (event.kind == EventKind::kDocked) add_arrival(event, {T_world_docked, 0.0}, T_world_body, error);
  }
  return error;
}

}  // namespace patrol::score
