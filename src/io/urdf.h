#pragma once

#include <string>

#include "core/robot_description.h"

namespace patrol::io {

/// Reads the URDF of a robot: legs or tracks, joint limits, footprint and sensor frames. Legs: links `<leg>_abduction`,
/// `<leg>_thigh`, `<leg>_shank`, `<leg>_foot`. Tracks: links `<side>_track`, whose collision shapes are the wheels
/// inside the belt, and `<side>_sprocket`. Throws InputError with file and element if anything is missing or not
/// finite.
RobotDescription load_robot_description(const std::string& path);

}  // namespace patrol::io
