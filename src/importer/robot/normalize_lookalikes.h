#pragma once

#include <set>
#include <string>

#include "importer/robot/robot_layout.h"

namespace patrol::importer {

/// Refuses a link of the chassis that looks like a wheel, but that no joint turns about its axle: often one wheel of
/// several with a wrong axis or type of its joint. It is a cylinder or a round mesh on the ground. It is across from a
/// wheel, or it has the radius of a wheel and is not one of a pair on fixed joints. `sliding`: links of the file that
/// are no wheels.
void refuse_unturned_wheels(const RobotLayout& layout, const std::set<std::string>& sliding);

}  // namespace patrol::importer
