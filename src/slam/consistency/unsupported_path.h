#pragma once

#include <vector>

#include "core/frames.h"
#include "core/time.h"
#include "slam/consistency/map_consistency.h"
#include "slam/consistency/odometry_check.h"

namespace patrol::slam {

/// Returns the parts of the path where at least 3 scans in a row matched no surfaces, and odometry contradicts 2 m or
/// more of the path within 5 s of them: nothing measured supports the path there. Most scans first. `stamps`: [scan].
std::vector<UnsupportedPath> find_unsupported_path(const std::vector<UnmatchedSegment>& unmatched,
                                                   const std::vector<FaultyOdometry>& faulty,
                                                   const std::vector<Time>& stamps);

/// Returns the gaps between scans of at least 5 s across which odometry and the path differ by 2 m or more, longest
/// first. All arguments: [scan].
std::vector<UnsupportedPath> find_unsupported_gaps(const std::vector<Pose2>& T_odom_body,
                                                   const std::vector<Pose2>& T_map_body,
                                                   const std::vector<Time>& stamps);

}  // namespace patrol::slam
