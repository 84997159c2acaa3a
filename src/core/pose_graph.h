#pragma once

#include <cstdint>
#include <vector>

#include <Eigen/Core>

#include "core/frames.h"

namespace patrol {

/// Relative pose measurement between two nodes of a pose graph.
struct PoseGraphEdge {
  enum class Kind : std::uint8_t {
    kOdometry,  ///< odometry between consecutive keyframes
    kMatch,     ///< match of a scan with a submap around it
    kLoop,      ///< loop closure: may be an outlier, hence gets a robust loss on request
  };
  int from = 0;
  int to = 0;
  Pose2 T_from_to;
  /// Information of x, y, yaw of `T_from_to`, expressed in `from`; 1/m^2, 1/rad^2.
  Eigen::Matrix3d information = Eigen::Matrix3d::Identity();
  Kind kind = Kind::kOdometry;
};

/// Graph of node poses and relative pose measurements [Lu97].
struct PoseGraph {
  std::vector<Pose2> T_map_node;
  std::vector<PoseGraphEdge> edges;
};

}  // namespace patrol
