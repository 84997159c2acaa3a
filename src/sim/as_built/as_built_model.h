#pragma once

#include <mujoco/mujoco.h>

#include "sim/as_built/as_built_robot.h"

namespace patrol::sim {

/// Applies the errors of the as-built robot to a compiled physics model: the pose of the site `imu`, the friction of
/// the feet and the gauge of the tracks. The other track errors are applied by TrackContact. MuJoCo's constants of the
/// reference configuration and the view model remain those of the nominal gauge.
void apply_as_built(const AsBuiltRobot& robot, mjModel& physics);

}  // namespace patrol::sim
