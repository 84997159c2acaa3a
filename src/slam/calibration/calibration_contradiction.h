#pragma once

#include <string>
#include <vector>

#include "slam/calibration/calibrate.h"
#include "slam/calibration/motion_segments.h"

namespace patrol::slam {

/// Returns why a calibration has no meaning: lidar and odometry turn in opposite directions in most segments, or fewer
/// than `min_segments` segments are not rejected. Empty: it has a meaning.
std::string calibration_contradiction(const std::vector<MotionSegment>& segments, const CalibrationResult& result,
                                      int min_segments);

}  // namespace patrol::slam
