#pragma once

#include <string>

#include "core/robot_description.h"

namespace patrol::io {

/// Reads the URDF of a robot: legs, wheels or tracks, joint limits, footprint and sensor frames. Legs: four chains of
/// three revolute joints, one about x and one about y of the body in either order, then a knee about y; the foot is a
/// sphere behind the third. Names of legs and wheels do not matter. Tracks: links `<side>_track`, whose collision
/// shapes are the wheels inside the belt, and `<side>_sprocket`. Throws InputError with file and element if anything is
/// missing or not finite.
RobotDescription load_robot_description(const std::string& path);

}  // namespace patrol::io
