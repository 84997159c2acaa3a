#include "score/goal_error.h"

#include <cmath>
#include <map>

#include "core/geometry/angles.h"

namespace patrol::score {
namespace {

std::optional<Pose2> truth_at(const Trajectory& T_world_body, Time stamp) {
  const std::optional<Pose3> truth = pose_at(T_world_body, stamp);
  return truth ? std::optional(to_pose2(*truth)) : std::nullopt;
}

Arrival arrival(int navigation, const Pose2& T_world_goal, const Pose2& T_world_truth) {
  return {.navigation = navigation,
          .position_error_m = (T_world_truth.position() - T_world_goal.position()).norm(),
          .heading_error_deg = to_deg(std::abs(wrap_angle(T_world_truth.yaw - T_world_goal.yaw)))};
}

/// True pose of each goal in world, by goal name.
std::map<std::string, Pose2> goal_poses(const std::vector<Event>& events, const std::vector<SavedGoal>& given,
                                        const Pose2& T_world_map, const Trajectory& T_world_body) {
  std::map<std::string, Pose2> wanted;
  for (const SavedGoal& goal : given) wanted["goal_" + std::to_string(goal.number)] = T_world_map * goal.T_map_body;
  for (const Event& event : events) {
    if (event.kind != EventKind::kGoalSaved) continue;
    if (const auto truth = truth_at(T_world_body, event.stamp)) wanted[event.subject] = *truth;
  }
  return wanted;
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
  for (const auto& [name, T_world_goal] : goal_poses(events, given, T_world_map, T_world_body)) {
    GoalError error{.name = name, .arrivals = {}};
    for (const Event& event : events) {
      if (event.subject != name) continue;
      if (event.kind == EventKind::kGoalFailed) ++error.num_failed;
      if (event.kind != EventKind::kGoalReached) continue;
      if (const auto truth = truth_at(T_world_body, event.stamp)) {
        error.arrivals.push_back(arrival(static_cast<int>(event.value), T_world_goal, *truth));
      }
    }
    errors.push_back(std::move(error));
  }
  return errors;
}

GoalError docking_error(const std::vector<Event>& events, const Pose2& T_world_docked, const Trajectory& T_world_body) {
  GoalError error{.name = "dock", .arrivals = {}};
  for (const Event& event : events) {
    if (event.kind == EventKind::kDockFailed) ++error.num_failed;
    if (event.kind != EventKind::kDocked) continue;
    if (const auto truth = truth_at(T_world_body, event.stamp)) {
      error.arrivals.push_back(arrival(static_cast<int>(event.value), T_world_docked, *truth));
    }
  }
  return error;
}

}  // namespace patrol::score
