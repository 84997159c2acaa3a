#pragma once

#include <cstddef>
#include <vector>

#include "core/frames.h"
#include "core/sensors/recorded_scan.h"
#include "slam/consistency/map_consistency.h"

namespace patrol::slam {

/// Finds scans of a frozen lidar: at least 5 scans in a row with the same ranges, bit by bit, over which odometry moves
/// by 0.2 m or 0.2 rad. Noise never repeats a scan. Scans with fewer than 3 returns are not considered.
class FrozenScans {
 public:
  /// Adds the next scan of the log.
  void add(const RecordedScan& recorded);
  /// Returns the scans that repeat the one before them, most scans first. `T_map_body` [scan]: their poses.
  std::vector<UnmatchedSegment> find(const std::vector<Pose2>& T_map_body) const;

 private:
  /// Equal scans: the first one and its repetitions.
  struct Repetition {
    std::size_t first_scan = 0, num_repeats = 0;
    Pose2 T_odom_first;
    bool has_moved = false;
  };
  static bool is_frozen(const Repetition& repetition);

  std::size_t num_scans_ = 0;
  std::vector<float> last_ranges_m_;
  Repetition newest_;
  std::vector<Repetition> frozen_;  ///< complete ones
};

/// Returns the number of scans of all segments.
std::size_t num_scans_of(const std::vector<UnmatchedSegment>& segments);

}  // namespace patrol::slam
