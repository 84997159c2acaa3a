#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include <mujoco/mujoco.h>

#include "core/ground_truth.h"
#include "core/messages.h"
#include "core/trajectory.h"
#include "render/film/approach.h"

namespace patrol::render {

/// How far the estimate was off.
struct EstimateError {
  Time at{};
  Eigen::Vector2d error_in_world_m;  ///< estimated less true position, map and world joined at the start
};

/// What a log tells of a run as a whole: what its notable moments are found by.
struct RunHistory {
  int num_states = 0;   ///< that a replay can show
  Time begin{}, end{};  ///< of those
  Trajectory T_world_body;  ///< true
  std::vector<EstimateError> errors;
  std::vector<Approach> approaches;  ///< to people and vehicles, where they were near
  std::vector<Event> events;
  std::vector<Collision> collisions;
};

/// Reads the whole log. Throws InputError when it cannot be read, or is of another model than `view`.
RunHistory read_run_history(const std::filesystem::path& log_mcap, const mjModel& view, const Pose2& T_world_map);

}  // namespace patrol::render
