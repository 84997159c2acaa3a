#pragma once

#include "importer/robot/robot_layout.h"

namespace patrol::importer {

/// Reports what makes the robot unlikely or hard to drive: its balance, its clearance above the ground and its masses.
void check_normalized(const RobotLayout& layout, NormalizedRobot& robot);

}  // namespace patrol::importer
