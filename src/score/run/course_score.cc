#include "score/run/course_score.h"

#include <algorithm>

namespace patrol::score {

CourseScore course_score(const RunRecord& record, const Eigen::Vector2d& p_world_goal_m, double arrival_m,
                         double optimal_time_s) {
  constexpr double kStartDistance_m = 0.1;
  constexpr double kMinRatio = 2.0, kMaxRatio = 8.0;  // multiples of the optimal time
  CourseScore result;
  std::optional<Time> start, arrival;
  for (const StampedPose& pose : record.T_world_body) {
    const Eigen::Vector2d p = pose.pose.position.head<2>();
    if (!start && (p - record.T_world_body.front().pose.position.head<2>()).norm() > kStartDistance_m)
      start = pose.stamp;
    if ((p - p_world_goal_m).norm() > arrival_m) continue;
    arrival = pose.stamp;
    break;
  }
  result.has_collided = std::any_of(record.collisions.begin(), record.collisions.end(),
                                    [&](const Collision& one) { return !arrival || one.stamp <= *arrival; });
  if (!arrival) return result;
  result.duration_s = to_seconds(*arrival - start.value_or(*arrival));
  result.is_successful = !result.has_collided;
  if (result.is_successful)
    result.score =
        optimal_time_s / std::clamp(*result.duration_s, kMinRatio * optimal_time_s, kMaxRatio * optimal_time_s);
  return result;
}

}  // namespace patrol::score
