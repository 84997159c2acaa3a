#pragma once

#include <mujoco/mujoco.h>
#include <urdf_model/link.h>
#include <urdf_model/model.h>

#include "sim/robot_model.h"

namespace patrol::sim {

// Wheel in the physics model: a rolling ellipsoid with the radius and the width of the wheel in the URDF.
//
// On level ground it touches at one point in the middle of the tread, so that the gauge is that of the URDF. The
// friction is the same in all directions; stiffness and friction come from locomotion/tire_contact.h. Not modeled: the
// moment of the contact patch about its own center, and the side slip angle of a tire.

/// Returns whether the link is a wheel of a robot with wheels: on a continuous joint and without children.
bool is_wheel(const urdf::Link& link);

bool has_wheels(const urdf::ModelInterface& robot);

/// Adds the contact shape of a wheel to its body, with a geom named as the link. Throws InputError for a link whose
/// collision shape is neither a cylinder nor a sphere.
void add_rolling_shape(const urdf::Link& wheel, mjsBody& body);

/// Selects elliptic friction cones. Wheels that slide sideways in a turn need friction that is the same in all
/// directions.
void use_wheel_friction(mjOption& option);

/// Returns the stance 5 mm above the highest ground below any wheel.
Stance stance_on_wheels(const urdf::ModelInterface& robot);

}  // namespace patrol::sim
