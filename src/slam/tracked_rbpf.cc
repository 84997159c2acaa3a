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

Pose2 TrackedRbpf::update(const LevelScan& scan, const Pose2& T_odom_body) {
  return filtered_.update(scan, tracker_.update(scan, T_odom_body).T_local_body).T_map_body;
}

PoseGraph TrackedRbpf::graph() const {
  PoseGraph graph{.T_map_node = filtered_.filter().best_path(), .edges = {}};
  for (std::size_t i = 0; i + 1 < graph.T_map_node.size(); ++i) {
    graph.edges.push_back({.from = static_cast<int>(i),
                           .to = static_cast<int>(i) + 1,
                           .T_from_to = graph.T_map_node[i].inverse() * graph.T_map_node[i + 1],
                           .information = Eigen::Matrix3d::Identity(),  // nothing weighs them
                           .kind = PoseGraphEdge::Kind::kOdometry});
  }
  return graph;
}

}  // namespace patrol::slam
