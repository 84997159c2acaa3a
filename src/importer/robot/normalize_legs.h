#pragma once

#include "importer/robot/link_builder.h"
#include "importer/robot/robot_layout.h"

namespace patrol::importer {

/// Adds three links for each leg, in the frames of the file, and its foot.
void add_legs(const RobotLayout& layout, LinkBuilder& links, NormalizedRobot& robot);

}  // namespace patrol::importer
