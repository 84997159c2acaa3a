#pragma once

#include <vector>

#include "slam/graph/submap.h"
#include "slam/grid_map.h"

namespace patrol::slam {

/// Map of all keyframes for online use: new keyframes are integrated once, and the whole map is rendered again if
/// earlier ones have moved.
class IncrementalMap {
 public:
  explicit IncrementalMap(const MapRenderingSettings& rendering)
      : rendering_(rendering), map_(rendering.resolution_m, rendering.max_extent_m) {}

  /// Returns the map of all keyframes. It is rendered again if a keyframe has moved by more than `max_displacement_m`,
  /// which includes the effect of its yaw at 10 m.
  const GridMap& render(const std::vector<Keyframe>& keyframes, const std::vector<Pose2>& T_map_node,
                        double max_displacement_m);

  /// Saves the poses at which the keyframes were integrated, or integrates them again.
  template <typename Archive>
  void serialize_state(Archive& archive, const std::vector<Keyframe>& keyframes) {
    archive(T_map_integrated_);
    if (archive.is_loading()) integrate_again(keyframes);
  }

 private:
  void integrate_again(const std::vector<Keyframe>& keyframes);

  MapRenderingSettings rendering_;
  GridMap map_;
  std::vector<Pose2> T_map_integrated_;  ///< [keyframe], pose at integration
};

}  // namespace patrol::slam
