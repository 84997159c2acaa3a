#pragma once

#include <Eigen/Core>

#include <cstdint>
#include <vector>

#include "core/frames.h"

namespace patrol {

/// What was measured of one node's place as seen from another.
struct PoseGraphEdge {
  enum class Kind : std::uint8_t {
    kOdometry,  ///< from keyframe to keyframe
    kMatch,     ///< of a scan with the submap around it
    kLoop,      ///< found again after a while: may be wrong, and is doubted where it does not fit
  };
  int from = 0;
  int to = 0;
  Pose2 T_from_to;
  Eigen::Matrix3d information = Eigen::Matrix3d::Identity();  ///< of x, y, yaw in `from`; 1/m^2, 1/rad^2
  Kind kind = Kind::kOdometry;
};

/// Places and what is known of how they lie to each other (Lu, Milios, "Globally consistent range scan alignment for environment mapping",
/// Autonomous Robots 1997).
struct PoseGraph {
  std::vector<Pose2> T_map_node;
  std::vector<PoseGraphEdge> edges;
};

}  // namespace patrol
