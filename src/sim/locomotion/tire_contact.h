#pragma once

#include <mujoco/mujoco.h>

#include "core/robot_description.h"
#include "sim/as_built/sensor_errors.h"
#include "sim/locomotion/wheel_drive_settings.h"

namespace patrol::sim {

/// Sets the contact of the wheels with the ground in `physics`, and the friction of their joints.
///
/// A tire is a soft spring: it deflects by `tire_deflection_ratio` of its radius under the weight on its wheel. With
/// the usual stiff contacts of MuJoCo, wheels that slide sideways lift off and bounce, and the robot turns at half the
/// yaw rate. The spring of small wheels is softer: its oscillation under the load advances by at most
/// 0.25 rad in a time step, a deflection of 0.63 mm at 2 ms. The shape is enlarged by half of the deflection, so that
/// the rolling radius under the nominal load is that of the URDF. Friction is 1000 times as stiff (`impratio`), so that
/// a standing robot does not creep.
///
/// The rotor inertias must be set before. Throws InputError when the model lacks a wheel of the robot.
void set_tires(const RobotDescription& robot, const WheelDriveSettings& settings, const WheelErrors& errors,
               mjModel& physics);

}  // namespace patrol::sim
