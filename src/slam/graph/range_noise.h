#pragma once

#include <optional>
#include <vector>

#include "core/sensors/lidar.h"
#include "slam/graph/scan_tracker_settings.h"

namespace patrol::slam {

/// Estimates the standard deviation of the ranges of a lidar from its scans.
///
/// On a surface, a range differs from the mean of its two neighbors by noise with 3/2 of its variance, and by
/// curvature, which is small between beams that are at most 0.15 m apart. The median of the differences leaves out
/// edges.
class RangeNoiseEstimator {
 public:
  void add(const LaserScan& scan);
  /// Standard deviation; none if fewer than 1000 ranges have neighbors, for example with sparse beams.
  std::optional<double> std_m() const;

 private:
  std::vector<float> differences_m_;  ///< absolute values
};

/// Adapts the settings of the tracker to ranges with a standard deviation of more than 0.04 m, which are smoothed along
/// the scan (range_smoothing.h). The surfaces of a map are then thicker than the neighborhoods in which lines are
/// fitted, and more scans are averaged: a keyframe contains all scans since the last one, and keyframes are closer.
/// Up to 0.2 m, maps are shorter, so that the final optimization matches each keyframe with several of them, whose
/// errors are independent. Settings that go further remain. Returns whether the deviation is that large.
bool adapt_to_range_noise(double range_std_m, ScanTrackerSettings& settings);

}  // namespace patrol::slam
