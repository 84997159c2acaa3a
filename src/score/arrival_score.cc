#include "score/arrival_score.h"

#include <algorithm>

#include "core/route.h"

namespace patrol::score {
namespace {

bool is_report_of(const Event& event, const MissionGoal& goal) {
  return event.kind == goal.arrival && (goal.name.empty() || event.subject == goal.name);
}

/// Replaces or adds the goals that the robot saved.
void add_saved_goals(const std::vector<Event>& events, const Trajectory& T_world_body,
                     std::vector<MissionGoal>& goals) {
  for (const Event& event : events) {
    if (event.kind != EventKind::kGoalSaved) continue;
    std::erase_if(goals, [&](const MissionGoal& goal) {
      return goal.arrival == EventKind::kGoalReached && goal.name == event.subject;
    });
    goals.push_back({.name = event.subject,
                     .arrival = EventKind::kGoalReached,
                     .p_world_m = true_pose_of(event, T_world_body).position(),
                     .accuracy_m = SavedGoal{}.accuracy_m,
                     .is_required = false});
  }
}

}  // namespace

Pose2 true_pose_of(const Event& event, const Trajectory& T_world_body) {
  const Time stamp = std::clamp(event.stamp, T_world_body.front().stamp, T_world_body.back().stamp);
  return to_pose2(pose_at(T_world_body, stamp).value());
}

bool is_arrival(const Eigen::Vector2d& p_world_body_m, const Eigen::Vector2d& p_world_goal_m, double accuracy_m) {
  return (p_world_body_m - p_world_goal_m).norm() <= kArrivalTolerance_m + accuracy_m;
}

ArrivalScore arrival_score(const std::vector<Event>& events, std::vector<MissionGoal> goals,
                           const Trajectory& T_world_body) {
  add_saved_goals(events, T_world_body, goals);
  ArrivalScore score;
  for (const MissionGoal& goal : goals) {
    bool is_visited = false, is_expected = goal.is_required;
    for (const Event& event : events) {
      if (!is_report_of(event, goal)) continue;
      is_expected = true;
      if (is_arrival(true_pose_of(event, T_world_body).position(), goal.p_world_m, goal.accuracy_m)) is_visited = true;
      else ++score.num_false;
    }
    if (is_expected && !is_visited) score.is_contradicted = true;
  }
  return score;
}

}  // namespace patrol::score
