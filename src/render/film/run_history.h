#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include <mujoco/mujoco.h>

#include "core/ground_truth.h"
#include "core/inspection_result.h"
#include "core/messages.h"
#include "core/trajectory.h"
#include "render/film/approach.h"

namespace patrol::render {

/// Position error of the estimate.
struct EstimateError {
  Time at{};
  Eigen::Vector2d error_in_world_m;  ///< estimated minus true position; map and world aligned at the start
};

/// Data of a whole run for the detection of highlights.
struct RunHistory {
  int num_states = 0;   ///< number of states that a replay can show
  Time begin{}, end{};  ///< times of the first and last state
  bool log_is_complete = true;
  Trajectory T_world_body;  ///< ground truth
  std::vector<EstimateError> errors;
  std::vector<Approach> approaches;  ///< approaches to pedestrians and vehicles, within ApproachFinder::kMaxRange_m
  std::vector<Event> events;
  std::vector<Collision> collisions;
  std::vector<RingFinding> ring_findings;  ///< findings of all lining results
};

/// Reads the whole log. Throws InputError when the log cannot be read or belongs to another model than `view`.
RunHistory read_run_history(const std::filesystem::path& log_mcap, const mjModel& view, const Pose2& T_world_map);

}  // namespace patrol::render
