#pragma once

#include "importer/robot/link_builder.h"
#include "importer/robot/robot_layout.h"

namespace patrol::importer {

/// Adds carriers and wheels. The frames of both are parallel to base_link; a wheel's origin is its center.
void add_wheels(const RobotLayout& layout, LinkBuilder& links, NormalizedRobot& robot);

/// Reports friction coefficients of Gazebo on parts that touch the ground. They are not used: many are tuned for its
/// contact solver, as 0.01 in place of mecanum rollers.
void report_frictions(const RobotLayout& layout, NormalizedRobot& robot);

}  // namespace patrol::importer
