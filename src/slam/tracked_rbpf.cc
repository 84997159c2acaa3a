#include "slam/tracked_rbpf.h"

namespace patrol::slam {

GridSlamSettings tracked_filter() {
  GridSlamSettings settings;
  settings.max_extent_m = 2000.0;
  settings.particles = 30;
  settings.initial_keyframes = 10;
  settings.motion = {.along_std_m_per_m = 0.02,
                     .across_std_m_per_m = 0.02,
                     .turn_std_rad_per_rad = 0.02,
                     .turn_std_rad_per_m = 0.005,
                     .turn_std_rad_per_s = 0.0,
                     .min_std_m = 0.005,
                     .min_std_rad = 0.002};
  return settings;
}

TrackedRbpf::TrackedRbpf(const TrackedRbpfSettings& settings, std::uint64_t seed) : tracker_(settings.tracking), filtered_(settings.filter, seed) {}

SlamUpdate TrackedRbpf::update(const LevelScan& scan, const Pose2& T_odom_body) {
  return filtered_.update(scan, tracker_.update(scan, T_odom_body).T_local_body);
}

}  // namespace patrol::slam
