#pragma once

#include <optional>

#include <Eigen/Core>

#include "score/run_record.h"

namespace patrol::score {

/// Result of an obstacle course by the metric of the BARN challenge: the optimal time divided by the time taken, which
/// counts as at least twice and at most eight times the optimal time. So the score is at most 0.5; it is 0 without
/// success. (Before 2024 the challenge counted at least four times, at most 0.25.)
struct CourseScore {
  bool is_successful = false;        ///< whether the robot came within the arrival distance without a collision
  bool has_collided = false;         ///< whether it collided before it arrived
  std::optional<double> duration_s;  ///< time from the first 0.1 m of the way to the arrival; none if it did not arrive
  double score = 0.0;
};

/// Scores a run by its ground truth. `p_world_goal_m`: goal of the course.
CourseScore course_score(const RunRecord& record, const Eigen::Vector2d& p_world_goal_m, double arrival_m,
                         double optimal_time_s);

}  // namespace patrol::score
