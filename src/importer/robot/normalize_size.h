#pragma once

#include "importer/robot/robot_layout.h"

namespace patrol::importer {

/// Computes the length and the turning radius of the robot and, of a robot with steered wheels, its distance from
/// keep-out lines.
void measure_size(const RobotLayout& layout, NormalizedRobot& robot);

}  // namespace patrol::importer
