#pragma once

#include "slam/graph/scan_group.h"

namespace patrol::slam {

/// Scans since the last keyframe, which consists of all of them. Of several in the same place it keeps the
/// newest.
class ScansSinceKeyframe {
 public:
  void add(const LevelScan& scan, const Pose2& T_local_body);
  void clear() { scans_ = {}; }
  bool is_empty() const { return scans_.is_empty(); }
  /// Returns the scans and removes them.
  ScanGroup take();

  template <typename Archive>
  void serialize_state(Archive& archive) {
    archive(scans_, T_local_newest_, T_local_distinct_);
  }

 private:
  ScanGroup scans_;
  Pose2 T_local_newest_, T_local_distinct_;  ///< newest scan; newest but for those in the same place
};

}  // namespace patrol::slam
