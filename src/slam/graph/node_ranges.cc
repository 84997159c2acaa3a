#include "slam/graph/node_ranges.h"

#include <cmath>

namespace patrol::slam {

Pose2 NodeRange::T_map_judged(const Pose2& T_map_node) const {
  if (!direction) return T_map_node;
  const Eigen::Vector2d p = T_map_read.position() + direction->dot(T_map_node.position() - T_map_read.position()) * *direction;
  return {p.x(), p.y(), T_map_read.yaw};
}

void NodeRanges::add(int node, const Pose2& T_map_node, const Pose2& T_node_then, const RangeSighting& sighting, const std::optional<Eigen::Vector2d>& direction) {
  const auto predicted_m = [&](const Pose2& T_map_body) { return predict_uwb_range(sighting.anchor, T_map_body, sighting.p_level_antenna, settings_.calibration).range_m; };
  const double at_node_m = sighting.range_m - predicted_m(T_map_node * T_node_then) + predicted_m(T_map_node);
  for (auto range = ranges_.rbegin(); range != ranges_.rend() && range->node == node; ++range) {
    if (range->anchor.number != sighting.anchor.number) continue;
    range->range_m += (at_node_m - range->range_m) / ++range->count;
    return;
  }
  ranges_.push_back({.node = node, .anchor = sighting.anchor, .p_level_antenna = sighting.p_level_antenna, .range_m = at_node_m, .count = 1, .T_map_read = T_map_node, .direction = direction});
}

double NodeRanges::std_m(const NodeRange& range) const { return settings_.range_std_m / std::sqrt(range.count); }

}  // namespace patrol::slam
