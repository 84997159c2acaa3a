#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "app/check/check_robot.h"

namespace patrol::app {

/// Beams of a lidar that hit the robot itself in its start posture. Its housing is ignored.
struct BlockedBeams {
  std::string frame;               ///< frame of the lidar
  double ratio = 0.0;              ///< number of these beams to that of all beams
  std::vector<std::string> links;  ///< links that the beams hit first, by decreasing number of beams
};

/// Returns the blocked beams of all lidars of a robot. Writes a world into `folder`. Throws InputError if the URDF is
/// invalid.
std::vector<BlockedBeams> blocked_beams(const CheckRobot& robot, const std::filesystem::path& folder);

/// Returns a sentence for each lidar of which more than 5 % of the beams are blocked.
std::vector<std::string> warnings_of(const std::vector<BlockedBeams>& lidars);

}  // namespace patrol::app
