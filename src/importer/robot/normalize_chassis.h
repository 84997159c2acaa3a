#pragma once

#include "importer/robot/link_builder.h"
#include "importer/robot/robot_layout.h"

namespace patrol::importer {

/// Adds base_link and the links that are fixed to it.
void add_chassis(const RobotLayout& layout, LinkBuilder& links, NormalizedRobot& robot);

/// Returns the mass of all links of the result.
double total_mass_kg(const NormalizedRobot& robot);

}  // namespace patrol::importer
