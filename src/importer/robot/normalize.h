#pragma once

#include <map>
#include <set>
#include <string>

#include "importer/robot/normalized_robot.h"
#include "importer/robot/source_robot.h"

namespace patrol::importer {

/// Choices of the user where a rule would decide.
struct NormalizeOptions {
  std::string name;                           ///< name of the robot
  std::string base_link;                      ///< link of the file; empty: by rule
  std::string forward;                        ///< direction of travel in the base: x, -x, y or -y; empty: by the axles
  std::map<std::string, std::string> frames;  ///< sensor frame of Patrol to link of the file
  std::set<std::string> casters = {};         ///< links of the file that slide although they look like wheels
  std::string drive = {};                     ///< differential, ackermann, mecanum or legs; empty: by rule
};

/// Turns a description into Patrol's conventions (importer/README.md). Throws InputError with file, line and element.
NormalizedRobot normalize(const SourceRobot& source, const NormalizeOptions& options);

}  // namespace patrol::importer
