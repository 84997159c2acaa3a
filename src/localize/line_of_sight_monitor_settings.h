#pragma once

#include "core/settings.h"

namespace patrol::localize {

/// Settings of the detection of UWB ranges without line of sight.
struct LineOfSightMonitorSettings {
  double range_std_m = 0.1;  ///< standard deviation of a UWB range in line of sight
  /// Maximum ratio of the scatter of UWB ranges in line of sight to its expected value [Wylie96].
  double max_std_ratio = 1.4;
  int window_ranges = 16;  ///< maximum number of the newest ranges to an anchor whose scatter is evaluated
  /// Minimum number of ranges to an anchor; with fewer, the line of sight is unknown and the ranges are not used.
  int min_ranges = 6;
  double max_age_s = 10.0;  ///< maximum age of a range relative to the newest range to the same anchor

  template <typename Self, typename Visitor>
  static void fields(Self& self, Visitor& visit) {
    visit("range_std_m", self.range_std_m, between(1e-3, 10.0));
    visit("max_std_ratio", self.max_std_ratio, between(1.0, 1e6));
    visit("window_ranges", self.window_ranges, between(2, 1000));
    visit("min_ranges", self.min_ranges, between(2, 1000));
    visit("max_age_s", self.max_age_s, between(0.1, 1e4));
  }
};

}  // namespace patrol::localize
