#include "stack/settings/stack_settings.h"

#include "slam/methods/mapper.h"

namespace patrol::stack {

slam::GraphSlamSettings default_graph_settings() {
  slam::GraphSlamSettings settings;
  settings.scan_odometry.motion = {};
  settings.scan_odometry.keyframe_distance_m = 0.5;
  settings.scan_odometry.initial_keyframes = 25;
  settings.cached_submaps = 6;
  settings.min_occupied_hit_ratio = 0.5;
  settings.edge_std_m = 0.003;
  settings.edge_std_rad = 0.0001;
  return settings;
}

slam::ScanOdometryRbpfSettings default_rbpf_settings() {
  return {.odometry = "given", .scan_odometry = {}, .filter = {}};
}

slam::MapperSettings default_slam_settings() {
  slam::MapperSettings settings;
  settings.graph = default_graph_settings();
  settings.rbpf = default_rbpf_settings();
  return settings;
}

}  // namespace patrol::stack
