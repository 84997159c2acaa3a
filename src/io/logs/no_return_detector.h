#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <optional>

#include "core/sensors/recorded_scan.h"

namespace patrol::io {

/// Range that a lidar reports instead of "no return".
struct NoReturnValue {
  double range_m = 0.0;
  std::uint64_t num_readings = 0;   ///< number of readings with this value in the examined scans
  std::uint64_t num_positions = 0;  ///< number of robot positions with such readings
};

/// Detector of the range that encodes "no return" in the first scans of a log. Examples: 81.83 m and 8.19 m (SICK), 50
/// m, 5.6 m.
///
/// Criteria: the value is at least 98 % of the maximum range and is bit-identical at many robot positions. It is read
/// at least five times as often as any other single range not far below. A wall does not meet the criteria: while the
/// robot moves, the maximum ranges vary and are few. A scan is examined only after the robot has moved since the last
/// examined one, because a stationary robot in front of a wall gives no evidence. If a lidar reports several such
/// values (SICK codes differ by millimeters), the lowest is returned.
class NoReturnDetector {
 public:
  void add(const RecordedScan& recorded);
  /// Returns whether enough scans were examined; further scans are not needed.
  bool is_conclusive() const;
  std::optional<NoReturnValue> find() const;

 private:
  struct Count {
    std::uint64_t readings = 0, positions = 0, last_position = 0;
  };

  std::optional<Pose2> T_odom_examined_;
  std::uint64_t num_positions_ = 0, num_readings_ = 0;
  std::map<float, Count> counts_;  ///< counts by range, m; ranges within 25 % of the maximum only
};

}  // namespace patrol::io
