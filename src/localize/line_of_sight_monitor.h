#pragma once

#include <cstddef>
#include <deque>
#include <map>

#include "core/time.h"
#include "localize/line_of_sight_monitor_settings.h"

namespace patrol::localize {

/// Detects UWB ranges without line of sight by their scatter [Wylie96]: the excess of an indirect path changes from
/// range to range. A constant error, such as an antenna delay or an error of the estimated pose, has no influence.
class LineOfSightMonitor {
 public:
  /// Throws InputError if a setting is out of range, or if the window is shorter than the minimum.
  explicit LineOfSightMonitor(const LineOfSightMonitorSettings& settings);

  /// Adds a range to an anchor. `innovation_m`: measured minus predicted range. Returns whether the newest ranges to
  /// the anchor are in line of sight. Stamps of one anchor must not decrease.
  bool add(int anchor, Time stamp, double innovation_m);
  /// Discards the ranges of all anchors.
  void reset() { windows_.clear(); }

  template <typename Archive>
  void serialize_state(Archive& archive) {
    archive(windows_);
  }

 private:
  struct Sample {
    Time stamp{};
    double innovation_m = 0.0;
  };

  LineOfSightMonitorSettings settings_;
  std::map<int, std::deque<Sample>> windows_;  ///< [anchor number] in order of time
};

}  // namespace patrol::localize
