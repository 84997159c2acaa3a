#pragma once

#include <mujoco/mujoco.h>
#include <urdf_model/link.h>
#include <urdf_model/model.h>

#include "sim/robot_model.h"

namespace patrol::sim {

// A track in the physics: its belt's road wheels on springs, and the wheels at its ends on the chassis. None of them turns: the
// belt's motion is the motion of their surfaces (locomotion/track_belts.h). On springs, since on a rigid chassis a handful of
// wheels carries everything, and the robot turns like a cart on four wheels.

bool is_track(const urdf::Link& link);

/// What each road wheel carries on level ground, N; 0 for a robot without tracks.
double road_wheel_load_n(const urdf::ModelInterface& robot);

/// Adds the wheels of `track` to its body: geoms named as the collision shapes, joints `<wheel>_spring`. Their mass is taken off
/// the body. `load_n` is what each road wheel carries where it stands in the URDF. Throws InputError for anything but cylinders.
void add_wheels(const urdf::Link& track, double load_n, mjsBody& body);

/// Reflected inertia of a sprocket's motor and belt, kg m2.
double sprocket_armature();

/// Pyramidal cones. Tracks slide whenever the robot turns, and a step with many sliding contacts costs half as much under
/// pyramidal cones as under elliptic ones (tests/bench/physics_bench.cc); a turn comes out within 3 % of isotropic friction's closed
/// form instead of 1 % (tests/scenario/tracks_test.cc).
void use_track_friction(mjOption& option);

/// A centimetre above the highest ground under any wheel: the robot settles from there in the first ticks, and does not turn on its springs.
Stance stance_on_tracks(const urdf::ModelInterface& robot);

}  // namespace patrol::sim
