#include "slam/graph/incremental_map.h"

#include <algorithm>
#include <cmath>

namespace patrol::slam {
namespace {

constexpr double kViewDistance_m = 10.0;

double displacement_m(const Pose2& a, const Pose2& b) {
  return (a.position() - b.position()).norm() + kViewDistance_m * std::abs(wrap_angle(a.yaw - b.yaw));
}

}  // namespace

const GridMap& IncrementalMap::render(const std::vector<Keyframe>& keyframes, const std::vector<Pose2>& T_map_node,
                                      double max_displacement_m) {
  const bool is_valid = std::equal(
      T_map_integrated_.begin(), T_map_integrated_.end(), T_map_node.begin(),
      T_map_node.begin() + static_cast<std::ptrdiff_t>(T_map_integrated_.size()),
      [&](const Pose2& written, const Pose2& now) { return displacement_m(written, now) <= max_displacement_m; });
  if (!is_valid) {
    map_ = GridMap(rendering_.resolution_m, rendering_.max_extent_m);
    T_map_integrated_.clear();
  }
  for (std::size_t k = T_map_integrated_.size(); k < keyframes.size(); ++k) {
    keyframes[k].scans.integrate(T_map_node[k], rendering_.integration, map_);
    T_map_integrated_.push_back(T_map_node[k]);
  }
  return map_;
}

void IncrementalMap::integrate_again(const std::vector<Keyframe>& keyframes) {
  map_ = GridMap(rendering_.resolution_m, rendering_.max_extent_m);
  for (std::size_t k = 0; k < T_map_integrated_.size(); ++k)
    keyframes.at(k).scans.integrate(T_map_integrated_[k], rendering_.integration, map_);
}

}  // namespace patrol::slam
