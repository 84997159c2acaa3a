#include "localize/amcl/range_memory.h"

#include <cmath>

namespace patrol::localize {

RangeMemory::RangeMemory(const std::vector<UwbAnchor>& anchors_in_map, const Eigen::Vector3d& p_body_antenna)
    : p_body_antenna_(p_body_antenna) {
  for (const UwbAnchor& anchor : anchors_in_map) p_map_anchor_[anchor.number] = anchor.p_m;
}

void RangeMemory::add(const UwbRange& range, const Pose2& T_odom_body) {
  if (!p_map_anchor_.contains(range.anchor) || !std::isfinite(range.range_m) || !(range.range_m > 0.0)) return;
  newest_[range.anchor] = {range, T_odom_body};
}

std::vector<AnchoredRange> RangeMemory::taken_after(Time since, const Pose2& T_odom_now) const {
  std::vector<AnchoredRange> ranges;
  for (const auto& [number, heard] : newest_) {
    if (heard.range.stamp <= since) continue;
    const Eigen::Vector2d antenna = (T_odom_now.inverse() * heard.T_odom_body) * p_body_antenna_.head<2>().eval();
    ranges.push_back({.p_map_anchor = p_map_anchor_.at(number),
                      .p_body_antenna = {antenna.x(), antenna.y(), p_body_antenna_.z()},
                      .range_m = heard.range.range_m});
  }
  return ranges;
}

}  // namespace patrol::localize
