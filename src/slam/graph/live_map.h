#pragma once

#include <vector>

#include "slam/graph/submap.h"
#include "slam/grid_map.h"

namespace patrol::slam {

/// Map of all keyframes for online use: new keyframes are integrated once, and the whole map is rendered again if
/// earlier ones have moved.
class LiveMap {
 public:
  explicit LiveMap(const MapDrawing& drawing) : drawing_(drawing), map_(drawing.resolution_m, drawing.max_extent_m) {}

  /// Returns the map of all keyframes. It is rendered again if a keyframe has moved by more than `max_shift_m`, which
  /// includes the effect of its yaw at 10 m.
  const GridMap& draw(const std::vector<Keyframe>& keyframes, const std::vector<Pose2>& T_map_node, double max_shift_m);

 private:
  MapDrawing drawing_;
  GridMap map_;
  std::vector<Pose2> written_at_;  ///< [keyframe], pose at integration
};

}  // namespace patrol::slam
