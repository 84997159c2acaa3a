#pragma once

#include <set>
#include <string>
#include <vector>

#include "importer/robot/robot_layout.h"

namespace patrol::importer {

inline constexpr double kSupportMassRatio = 0.03;  // of balls in place of fixed supports, to the robot

/// Replaces small wheels by balls that roll and swivel if they have neither motor nor vertical joint and are not on the
/// only driven axle: fixed in their direction, they would keep the robot from turning.
void release_fixed_casters(RobotLayout& layout, std::vector<Assumption>& rows);

/// Finds fixed parts that touch the ground beside the wheels. Boxes and meshes count only if the robot would tip over
/// without them. Adds balls below the chassis if it tips over all the same.
void find_supports(RobotLayout& layout, std::vector<Assumption>& rows);

}  // namespace patrol::importer
