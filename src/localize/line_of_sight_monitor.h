#pragma once

#include <cstddef>
#include <deque>
#include <map>

#include "core/settings.h"
#include "core/time.h"

namespace patrol::localize {

struct LineOfSightSettings {
  double range_std_m = 0.1;    ///< standard deviation of a range in line of sight
  double max_std_ratio = 1.4;  ///< ranges that scatter by more than this multiple of it are not in line of sight
  int window_ranges = 16;      ///< number of the newest ranges to an anchor that are compared
  int min_ranges = 6;          ///< below this number the line of sight is unknown, and the ranges are not used
  double max_age_s = 10.0;     ///< ranges that are older than the newest one by more are discarded

  template <typename Self, typename Visitor>
  static void fields(Self& self, Visitor& visit) {
    visit("range_std_m", self.range_std_m, between(1e-3, 10.0));
    visit("max_std_ratio", self.max_std_ratio, between(1.0, 1e6));
    visit("window_ranges", self.window_ranges, between(2, 1000));
    visit("min_ranges", self.min_ranges, between(2, 1000));
    visit("max_age_s", self.max_age_s, between(0.1, 1e4));
  }
};

/// Detects UWB ranges without line of sight by their scatter [Wylie96]: the excess of an indirect path changes from
/// range to range. A constant error, such as an antenna delay or an error of the estimated pose, has no influence.
class LineOfSightMonitor {
 public:
  /// Throws InputError if a setting is out of range.
  explicit LineOfSightMonitor(const LineOfSightSettings& settings);

  /// Adds a range to an anchor. `innovation_m`: measured minus predicted range. Returns whether the newest ranges to
  /// the anchor are in line of sight. Stamps of one anchor must not decrease.
  bool add(int anchor, Time stamp, double innovation_m);
  /// Discards the ranges of all anchors.
  void reset() { windows_.clear(); }

 private:
  struct Sample {
    Time stamp{};
    double innovation_m = 0.0;
  };

  LineOfSightSettings settings_;
  std::map<int, std::deque<Sample>> windows_;  ///< [anchor number] in order of time
};

}  // namespace patrol::localize
