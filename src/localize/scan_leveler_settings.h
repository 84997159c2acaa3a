#pragma once

#include "core/settings.h"

namespace patrol::localize {

/// Settings of the leveling and motion compensation of scans (scan_leveler.h).
struct ScanLevelerSettings {
  /// Minimum height of a hit that is an obstacle, above the ground under the robot; a curb of 0.12 m is lower.
  double min_height_m = 0.15;
  double max_height_m = 1.5;  ///< maximum height of a hit that is an obstacle, above the ground under the robot
  /// Slope of the minimum height over the distance: margin for tilt error and rising ground.
  double tilt_margin_rad = 0.008;
  /// Radius about the vertical axis of the body within which hits are the robot itself and beams are discarded.
  double self_filter_radius_m = 0.32;
  /// Distance that a beam without return clears: glass and black surfaces give no return.
  double no_return_clearing_range_m = 6.0;
  double max_range_m = 30.0;  ///< maximum range of a hit that is used
  /// Presence of a stabilized gimbal under the lidar: scans are level although the body tilts.
  bool gimbal_stabilized = false;

  template <typename Self, typename Visitor>
  static void fields(Self& self, Visitor& visit) {
    visit("min_height_m", self.min_height_m, between(-1.0, 5.0));
    visit("max_height_m", self.max_height_m, between(0.0, 20.0));
    visit("tilt_margin_rad", self.tilt_margin_rad, between(0.0, 0.2));
    visit("self_filter_radius_m", self.self_filter_radius_m, between(0.0, 2.0));
    visit("no_return_clearing_range_m", self.no_return_clearing_range_m, between(0.0, 100.0));
    visit("max_range_m", self.max_range_m, between(0.1, 400.0));
    visit("gimbal_stabilized", self.gimbal_stabilized);
  }
};

}  // namespace patrol::localize
