#pragma once

#include <string>

#include "core/robot_description.h"

namespace patrol::io {

/// Reads a robot's URDF: legs (links `<leg>_abduction`, `<leg>_thigh`, `<leg>_shank`, `<leg>_foot`) or tracks (links
/// `<side>_track`, whose collision shapes are the wheels that the belt runs round, and `<side>_sprocket`), joint limits,
/// footprint and sensor frames. Throws InputError, naming file and element, for anything missing or not finite.
RobotDescription load_robot_description(const std::string& path);

}  // namespace patrol::io
