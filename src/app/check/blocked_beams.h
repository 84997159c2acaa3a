#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "app/check/check_robot.h"

namespace patrol::app {

/// Beams of a lidar that hit the robot itself in its start posture. Its housing is ignored.
struct BlockedBeams {
  std::string frame;                        ///< frame of the lidar
  double ratio = 0.0;                       ///< number of these beams to that of all beams, with the nominal mount
  std::vector<std::string> links;           ///< links that the beams hit first, by decreasing number of beams
  double max_ratio = 0.0;                   ///< largest ratio of the mounts at the corners of as_built.mounting
  std::vector<std::string> max_links = {};  ///< `links` of this mount
};

/// Returns the blocked beams of all lidars of a robot. Of 3D lidars, at most 4,000 beams are cast for each mount but
/// the nominal one. Writes a world into `folder`. Throws InputError if the URDF is invalid.
std::vector<BlockedBeams> blocked_beams(const CheckRobot& robot, const std::filesystem::path& folder);

/// Returns a sentence for each lidar of which more than 5 % of the beams are blocked, with the nominal mount or with
/// another one within the tolerance.
std::vector<std::string> warnings_of(const std::vector<BlockedBeams>& lidars);

}  // namespace patrol::app
