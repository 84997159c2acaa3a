#pragma once

#include <cstddef>
#include <vector>

#include "core/messages.h"
#include "slam/match_points.h"
#include "slam/scan_integration.h"

namespace patrol::slam {

/// Consecutive scans that are mapped as one rigid body, because one alone has too few returns. The frame of the group
/// is `level` at its newest scan. A scan with enough returns is a group by itself.
class ScanGroup {
 public:
  ScanGroup() = default;
  explicit ScanGroup(LevelScan scan);
  /// Group of scans in the frame of the group, oldest first.
  explicit ScanGroup(std::vector<LevelScan> scans);

  /// Appends a scan, whose frame becomes that of the group. `T_before_now` is the motion since the scan before.
  void add(LevelScan scan, const Pose2& T_before_now);
  /// Replaces the newest scan by a later one.
  void replace_newest(LevelScan scan, const Pose2& T_before_now);

  bool is_empty() const { return members_.empty(); }
  std::size_t num_scans() const { return members_.size(); }
  Time stamp() const { return members_.back().scan.stamp; }

  /// The scans in the frame of the group, oldest first.
  std::vector<LevelScan> scans() const;
  /// Downsampled returns of all scans in the frame of the group (match_points.h).
  std::vector<MatchPoint> match_points(double spacing_m, int max_points) const;
  /// Integrates the scans into a map, oldest first.
  void integrate(const Pose2& T_map_group, const ScanIntegrationSettings& settings, GridMap& map) const;

  template <typename Archive>
  void serialize_state(Archive& archive) {
    archive(members_);
  }

 private:
  struct Member {
    LevelScan scan;
    Pose2 T_group_scan;
  };
  std::vector<Member> members_;  ///< in order of time
};

}  // namespace patrol::slam
