#pragma once

#include <vector>

#include "core/frames.h"
#include "core/time.h"

namespace patrol::localize {

/// Motion of the map by its final optimization, along the path on which it was made.
struct MapCorrection {
  std::vector<Time> stamps;      ///< [scan] stamps, ascending
  std::vector<Pose2> T_map_old;  ///< [scan] p_map = T_map_old * p_old for what the robot located at the scan

  /// Returns the motion at the last scan not after `stamp`, that at the first scan before it; identity without scans.
  Pose2 at(Time stamp) const;
};

}  // namespace patrol::localize
