#pragma once

#include "importer/robot/robot_layout.h"

namespace patrol::importer {

/// Chooses the settings of the leveled scan for a lidar near the ground.
void choose_scan_band(const RobotLayout& layout, NormalizedRobot& robot);

}  // namespace patrol::importer
