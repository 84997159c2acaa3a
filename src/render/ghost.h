#pragma once

#include <mujoco/mujoco.h>

#include "core/frames.h"

namespace patrol::render {

/// 0 ... 1: nothing for an error that nobody would see beside the robot, all of it from a hand's breadth on.
double ghost_opacity(const Pose2& T_true_estimate);

/// Adds a translucent copy of the robot where it believes to be, in the estimate's colour, to a scene that `data` was put into.
/// `T_true_estimate`: the level body as estimated, in the true one.
void add_ghost(mjvScene& scene, const mjModel& model, const mjData& data, const Pose2& T_true_estimate);

}  // namespace patrol::render
