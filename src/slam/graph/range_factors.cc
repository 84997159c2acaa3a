#include "slam/graph/range_factors.h"

#include <cmath>

namespace patrol::slam {

Pose2 RangeFactor::T_map_constrained(const Pose2& T_map_node) const {
  if (!direction) return T_map_node;
  const Eigen::Vector2d p = T_map_linearization.position() +
                            direction->dot(T_map_node.position() - T_map_linearization.position()) * *direction;
  return {p.x(), p.y(), T_map_linearization.yaw};
}

void RangeFactors::add(int node, const Pose2& T_map_node, const Pose2& T_node_then, const RangeMeasurement& measurement,
                       const std::optional<Eigen::Vector2d>& direction) {
  const auto predicted_m = [&](const Pose2& T_map_body) {
    return predict_uwb_range(measurement.anchor, T_map_body, measurement.p_level_antenna, settings_.calibration)
        .range_m;
  };
  const double range_at_node_m = measurement.range_m - predicted_m(T_map_node * T_node_then) + predicted_m(T_map_node);
  for (auto range = ranges_.rbegin(); range != ranges_.rend() && range->node == node; ++range) {
    if (range->anchor.number != measurement.anchor.number) continue;
    range->range_m += (range_at_node_m - range->range_m) / ++range->count;
    return;
  }
  ranges_.push_back({.node = node,
                     .anchor = measurement.anchor,
                     .p_level_antenna = measurement.p_level_antenna,
                     .range_m = range_at_node_m,
                     .count = 1,
                     .T_map_linearization = T_map_node,
                     .direction = direction});
}

double RangeFactors::std_m(const RangeFactor& range) const { return settings_.range_std_m / std::sqrt(range.count); }

}  // namespace patrol::slam
