#pragma once

#include <string>

#include "importer/robot/normalized_robot.h"

namespace patrol::importer {

/// Returns the text of NAME.yaml: the settings of a robot that differ from the defaults; `comment` is its first line.
std::string settings_of(const NormalizedRobot& robot, const std::string& comment);

}  // namespace patrol::importer
