#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "core/messages.h"

namespace patrol::stack {

/// Numbers of 2D scans by their use in a map.
struct ScanCounts {
  std::uint64_t num_received = 0;
  std::uint64_t num_without_pose = 0;  ///< scans before the odometry has settled, or outside its time span
  std::uint64_t num_without_hits = 0;  ///< no hit within range and height band, outside the self filter
  std::uint64_t num_tilted = 0;        ///< tilted by more than the maximum tilt of the SLAM method

  /// Counts a received scan. `level`: its level scan; none without a pose.
  void add(const std::optional<LevelScan>& level, double max_tilt_rad);
  /// Returns the number of scans that the SLAM method uses.
  std::uint64_t num_used() const { return num_received - num_without_pose - num_without_hits - num_tilted; }
  /// Returns a sentence for a map of which no scan was used, with the number of scans for each reason.
  std::string failure_text(double max_tilt_rad) const;

  template <typename Archive>
  void serialize_state(Archive& archive) {
    archive(num_received, num_without_pose, num_without_hits, num_tilted);
  }
};

}  // namespace patrol::stack
