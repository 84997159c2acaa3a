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

slam::ScanOdometryRbpfSettings default_rbpf_settings() { return {.odometry = "given", .scan_odometry = {}, .filter = {}}; }

std::unique_ptr<slam::Mapper> make_mapper(const StackSettings& settings, const BoostedStumps& neighbor_model, std::uint64_t seed) {
  return slam::make_mapper(
      {.method = settings.mapping, .graph = settings.graph, .rbpf = settings.slam, .submap_rbpf = settings.submap_rbpf}, neighbor_model, seed);
}

}  // namespace patrol::stack
