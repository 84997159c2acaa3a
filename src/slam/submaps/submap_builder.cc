#include "slam/submaps/submap_builder.h"

#include <cmath>
#include <utility>

#include "slam/rbpf/scan_odometry_rbpf.h"

namespace patrol::slam {

GridSlamSettings SubmapBuilderSettings::submap_filter_settings() {
  GridSlamSettings settings = default_filter_settings();
  settings.max_extent_m = 400.0;
  settings.particles = 10;
  settings.motion = {.longitudinal_std_m_per_m = 0.006,
                     .lateral_std_m_per_m = 0.006,
                     .yaw_std_rad_per_rad = 0.006,
                     .yaw_std_rad_per_m = 0.0015,
                     .yaw_std_rad_per_s = 0.0,
                     .min_std_m = 0.0015,
                     .min_std_rad = 0.0006};
  return settings;
}

Pose2 SubmapBuilder::update(const LevelScan& scan, const Pose2& T_odom_body) {
  if (T_odom_last_) {
    const Pose2 step = T_odom_last_->inverse() * T_odom_body;
    distance_m_ += step.position().norm();
    rotation_rad_ += std::abs(step.yaw);
  }
  T_odom_last_ = T_odom_body;
  const SlamUpdate update = filtered_.update(scan, T_odom_body);
  if (update.is_keyframe) scans_.push_back(scan);
  return update.T_map_body;
}

std::vector<Keyframe> SubmapBuilder::take_keyframes() {
  const std::vector<Pose2> T_submap_keyframe = filtered_.filter().best_path();
  std::vector<Keyframe> keyframes;
  for (std::size_t k = 0; k < scans_.size(); ++k)
    keyframes.push_back({ScanGroup(std::move(scans_[k])), T_submap_keyframe[k]});
  scans_.clear();
  return keyframes;
}

}  // namespace patrol::slam
