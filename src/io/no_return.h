#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <optional>

#include "core/sensors/recorded_scan.h"

namespace patrol::io {

/// What a lidar reports where nothing came back, if it reports a range there.
struct NoReturnValue {
  double range_m = 0.0;
  std::uint64_t num_readings = 0;  ///< that were it, in the scans looked at
  std::uint64_t num_places = 0;    ///< from which
};

/// Finds in a log's first scans the range that stands for no return: 81.83 m or 8.19 m of a SICK, 50 m, 5.6 m.
///
/// It is at the very top of the ranges, is the same to the bit from many places, and is read at least five times as often as any other single range not far
/// below. No wall is all of that: seen while the robot moves, its farthest ranges differ, and few. Scans are looked at where the robot has moved since the
/// last one, so that standing before a wall proves nothing. A lidar that reports several such values (SICK's codes differ by millimetres) has the lowest of
/// them found.
class NoReturnFinder {
 public:
  void add(const RecordedScan& recorded);
  /// More scans would not change its mind.
  bool has_seen_enough() const;
  std::optional<NoReturnValue> find() const;

 private:
  struct Count {
    std::uint64_t readings = 0, places = 0, last_place = 0;
  };

  std::optional<Pose2> T_odom_place_;
  std::uint64_t num_places_ = 0, num_readings_ = 0;
  std::map<float, Count> counts_;  ///< by range, m; of those that are not far below the top
};

}  // namespace patrol::io
