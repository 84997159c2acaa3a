#pragma once

#include "importer/robot/source_robot.h"

namespace patrol::importer {

/// Makes the fixed joints of wheels continuous in a description without wheels that turn and without legs. Such a wheel
/// is a link with a horizontal cylinder that is centered in the link, touches the ground and has another one across
/// from it. Each is an assumption of the description.
void release_fixed_wheels(SourceRobot& robot);

}  // namespace patrol::importer
