#pragma once

#include <string>
#include <vector>

#include "app/check/check_robot.h"

namespace patrol::app {

/// Returns the distance up to which hits of a level beam of the lidar `lidar` count for the built-in stack
/// (stack.scan_leveling): 0 below the minimum height, infinite without a tilt margin or without such a lidar.
double scan_reach_m(const CheckRobot& robot);

/// Returns a sentence if the reach of the scan is below 4 m because the lidar is near the ground.
std::vector<std::string> scan_reach_warnings(const CheckRobot& robot);

/// Returns a sentence for each 2D lidar whose scan plane is tilted by more than 10 degrees.
std::vector<std::string> scan_plane_warnings(const CheckRobot& robot);

}  // namespace patrol::app
