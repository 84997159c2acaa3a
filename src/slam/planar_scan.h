#pragma once

#include "core/messages.h"
#include "core/sensors/recorded_scan.h"
#include "core/settings.h"

namespace patrol::slam {

struct PlanarScanSettings {
  double min_range_m = 0.05;  ///< range below which returns are from the robot itself
  /// Range up to which beams that end farther away clear free space; their end points are too sparse for walls.
  double max_range_m = 40.0;
  /// Distance cleared by a beam without a return; small, since glass and black fabric give no return either.
  double no_return_clearing_range_m = 0.0;
  double range_std_m = 0.0;  ///< noise of the ranges, which are smoothed along the scan (range_smoothing.h); 0: none

  template <typename Self, typename Visitor>
  static void fields(Self& self, Visitor& visit) {
    visit("min_range_m", self.min_range_m, at_least(0.0));
    visit("max_range_m", self.max_range_m, between(0.1, 1000.0));
    visit("no_return_clearing_range_m", self.no_return_clearing_range_m, at_least(0.0));
    visit("range_std_m", self.range_std_m, at_least(0.0));
  }
};

/// Converts a recorded scan of a horizontal lidar to a LevelScan in the body frame at its first beam. If the log gives
/// the motion during the scan (`T_begin_end`), each beam is motion-compensated.
LevelScan planar_scan(const RecordedScan& recorded, const PlanarScanSettings& settings);

}  // namespace patrol::slam
