#pragma once

#include <vector>

#include "core/time.h"
#include "slam/consistency/map_consistency.h"
#include "slam/consistency/odometry_check.h"

namespace patrol::slam {

/// Returns the parts of the path where at least 3 scans in a row matched no surfaces, and odometry contradicts 2 m or
/// more of the path within 5 s of them: nothing measured supports the path there. Most scans first. `stamps`: [scan].
std::vector<UnsupportedPath> find_unsupported_path(const std::vector<UnmatchedSegment>& unmatched,
                                                   const std::vector<FaultyOdometry>& faulty,
                                                   const std::vector<Time>& stamps);

}  // namespace patrol::slam
