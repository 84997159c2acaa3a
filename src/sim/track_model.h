#pragma once

#include <mujoco/mujoco.h>
#include <urdf_model/link.h>
#include <urdf_model/model.h>

#include "sim/robot_model.h"

namespace patrol::sim {

// Track in the physics model: road wheels on springs, end wheels on the chassis.
//
// No wheel rotates; the motion of the track is a surface velocity of the wheels (locomotion/track_contact.h). Without
// springs, a few wheels would carry the whole load, and the robot would turn like a four-wheeled cart.

bool is_track(const urdf::Link& link);

/// Returns the load of each road wheel on level ground, N; 0 for a robot without tracks.
double road_wheel_load_n(const urdf::ModelInterface& robot);

/// Adds the wheels of `track` to its body, with geoms named as the collision shapes and joints `<wheel>_spring`. Mass
/// and center of mass of the track remain those of the URDF; its inertia is not reduced by theirs. `load_n` is the load
/// of each road wheel at its position in the URDF. Throws InputError for shapes other than cylinders.
void add_wheels(const urdf::Link& track, double load_n, mjsBody& body);

/// Returns the reflected inertia of a sprocket's motor and belt, kg m2.
double sprocket_armature();

/// Selects pyramidal friction cones and sparse algebra.
///
/// Tracks slide whenever the robot turns. A step with many sliding contacts costs half as much with pyramidal as with
/// elliptic cones (tests/bench/physics_bench.cc). A turn is within 3 % of the closed form of isotropic friction instead
/// of 1 % (tests/scenario/tracks_test.cc).
void use_track_options(mjOption& option);

/// Returns the stance 1 cm above the highest ground below any wheel. The robot settles from there in the first ticks
/// without oscillating on its springs.
Stance stance_on_tracks(const urdf::ModelInterface& robot);

}  // namespace patrol::sim
