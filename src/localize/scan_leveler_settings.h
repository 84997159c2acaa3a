#pragma once

#include "core/settings.h"

namespace patrol::localize {

struct ScanLevelerSettings {
  /// Height limits of obstacles above the ground under the feet; a curb of 0.12 m is lower.
  double min_height_m = 0.15;
  double max_height_m = 1.5;       ///< maximum height of a point that is used, above the lidar
  double tilt_margin_rad = 0.008;  ///< margin for an apparent rise of the ground with distance: tilt error and slope
  /// Distance from the vertical axis of the body below which hits are the robot itself.
  double self_filter_radius_m = 0.32;
  double no_return_clearing_range_m =
      6.0;                    ///< distance that a beam without return clears: glass and black surfaces give no return
  double max_range_m = 30.0;  ///< maximum range of a hit that is used
  bool gimbal_stabilized = false;  ///< presence of a stabilized gimbal: scans are level although the body tilts

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
