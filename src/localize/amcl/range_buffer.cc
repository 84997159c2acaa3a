#include "localize/amcl/range_buffer.h"

#include <cmath>
#include <utility>

namespace patrol::localize {

RangeBuffer::RangeBuffer(const std::vector<UwbAnchor>& anchors_in_map, Pose3 T_body_uwb, UwbCalibration calibration)
    : T_body_uwb_(std::move(T_body_uwb)), calibration_(std::move(calibration)) {
  set_anchors(anchors_in_map);
}

void RangeBuffer::set_anchors(const std::vector<UwbAnchor>& anchors_in_map) {
  for (const UwbAnchor& anchor : anchors_in_map) p_map_anchor_[anchor.number] = anchor.p_m;
}

void RangeBuffer::add(const UwbRange& range, const Pose3& T_odom_body) {
  if (!p_map_anchor_.contains(range.anchor) || !std::isfinite(range.range_m) || !(range.range_m > 0.0)) return;
  // The bias is a function of the true distance; two fixed-point iterations suffice, because it varies slowly.
  const double nearly_m = range.range_m - uwb_bias_at(calibration_, range.range_m).bias_m;
  newest_[range.anchor] = {.stamp = range.stamp,
                           .T_odom_body = to_pose2(T_odom_body),
                           .p_level_antenna = uwb_antenna_in_level(T_odom_body.rotation, T_body_uwb_, 0.0),
                           .distance_m = range.range_m - uwb_bias_at(calibration_, nearly_m).bias_m};
}

std::vector<AnchoredRange> RangeBuffer::ranges_since(Time since, const Pose2& T_odom_now) const {
  std::vector<AnchoredRange> ranges;
  for (const auto& [number, buffered] : newest_) {
    if (buffered.stamp <= since) continue;
    const Eigen::Vector2d antenna =
        (T_odom_now.inverse() * buffered.T_odom_body) * buffered.p_level_antenna.head<2>().eval();
    ranges.push_back({.p_map_anchor = p_map_anchor_.at(number),
                      .p_body_antenna = {antenna.x(), antenna.y(), buffered.p_level_antenna.z()},
                      .range_m = buffered.distance_m});
  }
  return ranges;
}

}  // namespace patrol::localize
