#pragma once

#include <string>

#include "importer/robot/normalized_robot.h"

namespace patrol::importer {

/// Chooses the settings of a lidar: the preset of its field of view and range; without one, the nearest preset with the
/// numbers of the file.
void choose_lidar(const std::string& frame, const LidarNumbers& stated, NormalizedRobot& robot);

}  // namespace patrol::importer
