#pragma once

#include "importer/robot/link_builder.h"
#include "importer/robot/robot_layout.h"

namespace patrol::importer {

/// Gives the carriers and wheels of very light casters mass of the chassis, and those with a small inertia an inertia
/// of twice this mass at the radius of the wheel: their contact is unstable otherwise. Adds the supports.
void add_casters(const RobotLayout& layout, LinkBuilder& links, NormalizedRobot& robot);

}  // namespace patrol::importer
