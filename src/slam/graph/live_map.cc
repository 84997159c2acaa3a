#include "slam/graph/live_map.h"

#include <algorithm>
#include <cmath>

namespace patrol::slam {
namespace {

constexpr double kSight_m = 10.0;

double shift_m(const Pose2& a, const Pose2& b) { return (a.position() - b.position()).norm() + kSight_m * std::abs(wrap_angle(a.yaw - b.yaw)); }

}  // namespace

const GridMap& LiveMap::draw(const std::vector<Keyframe>& keyframes, const std::vector<Pose2>& T_map_node, double max_shift_m) {
  const bool is_valid = std::equal(written_at_.begin(), written_at_.end(), T_map_node.begin(), T_map_node.begin() + static_cast<std::ptrdiff_t>(written_at_.size()),
                                   [&](const Pose2& written, const Pose2& now) { return shift_m(written, now) <= max_shift_m; });
  if (!is_valid) {
    map_ = GridMap(drawing_.resolution_m, drawing_.max_extent_m);
    written_at_.clear();
  }
  for (std::size_t k = written_at_.size(); k < keyframes.size(); ++k) {
    integrate_scan(keyframes[k].scan, T_map_node[k], drawing_.integration, map_);
    written_at_.push_back(T_map_node[k]);
  }
  return map_;
}

}  // namespace patrol::slam
