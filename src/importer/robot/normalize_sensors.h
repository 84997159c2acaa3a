#pragma once

#include "importer/robot/link_builder.h"
#include "importer/robot/normalize.h"
#include "importer/robot/robot_layout.h"

namespace patrol::importer {

/// Adds the frames of the sensors: by option, then those of the file, then an IMU if there is none. Chooses the
/// settings of the lidars.
void add_sensors(const RobotLayout& layout, const NormalizeOptions& options, LinkBuilder& links,
                 NormalizedRobot& robot);

}  // namespace patrol::importer
