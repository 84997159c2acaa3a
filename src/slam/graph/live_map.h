#pragma once

#include <vector>

#include "slam/graph/submap.h"
#include "slam/grid_map.h"

namespace patrol::slam {

/// The map of all keyframes, each written once where it was believed then, and all anew when some of them have moved since.
class LiveMap {
 public:
  explicit LiveMap(const MapDrawing& drawing) : drawing_(drawing), map_(drawing.resolution_m, drawing.max_extent_m) {}

  /// Of all keyframes; those that were written are left as they are unless one has moved farther than `max_shift_m`, what it sees ten metres away counted.
  const GridMap& draw(const std::vector<Keyframe>& keyframes, const std::vector<Pose2>& T_map_node, double max_shift_m);

 private:
  MapDrawing drawing_;
  GridMap map_;
  std::vector<Pose2> written_at_;  ///< [keyframe]
};

}  // namespace patrol::slam
