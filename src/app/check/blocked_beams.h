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
  /// Largest distance of hits with any of these mounts from the vertical axis of the body, m. Hits below the obstacles
  /// of the built-in stack do not count; 0 without others.
  double max_distance_m = 0.0;
};

/// Returns the blocked beams of all lidars of a robot. Of 3D lidars, at most 4,000 beams are cast for each mount but
/// the nominal one. Writes a world into `folder`. Throws InputError if the URDF is invalid.
std::vector<BlockedBeams> blocked_beams(const CheckRobot& robot, const std::filesystem::path& folder);

/// Returns a sentence for each lidar of which more than 5 % of the beams are blocked, with the nominal mount or with
/// another one within the tolerance. It names hits that the built-in stack does not ignore.
std::vector<std::string> warnings_of(const std::vector<BlockedBeams>& lidars,
                                     const localize::ScanLevelerSettings& scan_leveling);

}  // namespace patrol::app
