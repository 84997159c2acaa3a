#pragma once

#include "core/messages.h"
#include "core/sensors/recorded_scan.h"
#include "core/settings.h"

namespace patrol::slam {

struct PlanarScanSettings {
  double min_range_m = 0.05;      ///< nearer ones see the robot itself
  double max_range_m = 40.0;      ///< beams that end farther away are free so far, and their ends are left out: there they lie too far apart to be walls
  double no_return_free_m = 0.0;  ///< as far as a beam without return is taken to be free: glass and black cloth give none either

  template <typename Self, typename Visitor>
  static void fields(Self& self, Visitor& visit) {
    visit("min_range_m", self.min_range_m, at_least(0.0));
    visit("max_range_m", self.max_range_m, between(0.1, 1000.0));
    visit("no_return_free_m", self.no_return_free_m, at_least(0.0));
  }
};

/// The scan of a lidar that is level, on a robot that nobody knows more of: as seen from where the body was at its first beam. The others are moved by what
/// odometry says of the time in between, where the log says when they were fired.
LevelScan planar_scan(const RecordedScan& recorded, const PlanarScanSettings& settings);

}  // namespace patrol::slam
