#pragma once

#include "core/settings.h"

namespace patrol::localize {

/// Settings of the detection of UWB ranges without line of sight.
struct LineOfSightMonitorSettings {
  double range_std_m = 0.1;  ///< standard deviation of a range in line of sight
  /// Ratio of the scatter of ranges to its expected value above which they are not in line of sight.
  double max_std_ratio = 1.4;
  int window_ranges = 16;   ///< number of the newest ranges to an anchor that are compared
  int min_ranges = 6;       ///< number of ranges below which the line of sight is unknown, and the ranges are not used
  double max_age_s = 10.0;  ///< age relative to the newest range above which ranges are discarded

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
