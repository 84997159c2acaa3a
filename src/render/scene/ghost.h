#pragma once

#include <mujoco/mujoco.h>

#include "core/frames.h"

namespace patrol::render {

/// Opacity of the ghost, 0 ... 1: 0 for an error of at most 4 cm, 1 from 12 cm on. A yaw error counts with a lever of
/// 0.5 m.
double ghost_opacity(const Pose2& T_true_estimate);

/// Adds a translucent copy of the robot at its estimated pose, in the color of the estimate, to a scene made from
/// `data`. `T_true_estimate` is the estimated pose of the level body in the true one.
void add_ghost(mjvScene& scene, const mjModel& model, const mjData& data, const Pose2& T_true_estimate);

}  // namespace patrol::render
