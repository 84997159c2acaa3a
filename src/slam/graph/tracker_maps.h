#pragma once

#include "core/frames.h"
#include "slam/graph/scan_group.h"
#include "slam/graph/scan_tracker_settings.h"
#include "slam/grid_map.h"

namespace patrol::slam {

/// Maps of the last meters. Two are updated at a time; the second begins when the first is half full, and takes over
/// when the first is full. Scans are matched with the older map, which thus always has at least half the full length.
class TrackerMaps {
 public:
  explicit TrackerMaps(const ScanTrackerSettings& settings);

  /// The map with which scans are matched.
  const GridMap& older() const { return older_; }
  /// Number of integrated keyframes.
  int num_keyframes() const { return keyframes_; }
  /// Index of the older map: 0, 1, ...
  int submap() const { return submap_; }

  /// Integrates a keyframe. Returns whether a new map begins with it.
  bool integrate(const ScanGroup& scans, const Pose2& T_local_body, const ScanTrackerSettings& settings);

  template <typename Archive>
  void serialize_state(Archive& archive) {
    archive(older_, newer_, older_keyframes_, newer_keyframes_, keyframes_, submap_);
  }

 private:
  GridMap older_, newer_;
  int older_keyframes_ = 0, newer_keyframes_ = 0, keyframes_ = 0, submap_ = 0;
};

}  // namespace patrol::slam
