#pragma once

#include <string>

#include "importer/robot/robot_layout.h"

namespace patrol::importer {

/// Moves the origin of a lidar, the last link of the result, that is inside a visual shape of the chassis, or so near
/// that the tolerance of its mount may put it inside: all its beams would end there. Its housing is ignored and stays.
/// Upward, or to a side where this is less than a third of the distance. `link`: that of the file that carries it.
void clear_origin(const RobotLayout& layout, const std::string& frame, const std::string& link, NormalizedRobot& robot);

/// Reports a 2D lidar, the last link of the result, whose scan plane is not horizontal.
void check_scan_plane(const std::string& frame, NormalizedRobot& robot);

}  // namespace patrol::importer
