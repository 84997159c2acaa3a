#pragma once

#include <mujoco/mujoco.h>

#include "sim/as_built/as_built_robot.h"

namespace patrol::sim {

/// Applies the errors of the as-built robot to a compiled physics model: the pose of the site `imu` and the friction of
/// the feet. Track errors are applied by TrackContact.
void apply_as_built(const AsBuiltRobot& robot, mjModel& physics);

}  // namespace patrol::sim
