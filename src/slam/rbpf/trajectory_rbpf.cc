#include "slam/rbpf/trajectory_rbpf.h"

namespace patrol::slam {

SlamUpdate TrajectoryRbpf::update(const LevelScan& scan, const Pose2& T_odom_body) {
  SlamUpdate update = filter_.update(scan, T_odom_body);
  if (update.is_keyframe) {
    keyframe_scans_.push_back(path_.size());
    T_odom_keyframe_ = T_odom_body;
  }
  path_.push_back({keyframe_scans_.size() - 1, T_odom_keyframe_.inverse() * T_odom_body});
  return update;
}

std::vector<Pose2> TrajectoryRbpf::path() const {
  const std::vector<Pose2> keyframes = filter_.best_path();
  std::vector<Pose2> T_map_body;
  T_map_body.reserve(path_.size());
  for (const TrackedPose& pose : path_) T_map_body.push_back(keyframes[pose.keyframe] * pose.T_keyframe_body);
  return T_map_body;
}

PoseGraph TrajectoryRbpf::graph() const {
  PoseGraph graph{.T_map_node = filter_.best_path(), .edges = {}};
  for (std::size_t i = 0; i + 1 < graph.T_map_node.size(); ++i) {
    graph.edges.push_back({.from = static_cast<int>(i),
                           .to = static_cast<int>(i) + 1,
                           .T_from_to = graph.T_map_node[i].inverse() * graph.T_map_node[i + 1],
                           .information = Eigen::Matrix3d::Identity(),
                           .kind = PoseGraphEdge::Kind::kOdometry});
  }
  return graph;
}

}  // namespace patrol::slam
