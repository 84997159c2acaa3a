#pragma once

#include <vector>

#include "slam/pose_gaussian.h"

namespace patrol::slam {

/// Two places between which something was measured; walked either way.
struct UncertainWay {
  int from = 0;
  int to = 0;
  Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();  ///< of x, y, yaw of the one as seen from the other, in its frame; m, m, rad
};

/// [place]: where each lies as seen from `place`, and how surely, along the way to it that leaves least uncertain: Dijkstra's search, in place of the
/// covariance of the whole graph, which is not smaller (Olson, "Robust and efficient robotic mapping", MIT 2008, section 4.2). A radian counts as ten metres.
/// Places that no way leads to are infinitely uncertain.
std::vector<PoseGaussian> positions_from(int place, const std::vector<Pose2>& T_map_place, const std::vector<UncertainWay>& ways);

/// How surely `there` is known, where what is uncertain at `here` and on the way from it is; `way_covariance` as seen from here. Both in one frame, as is the result.
Eigen::Matrix3d carried_on(const PoseGaussian& here, const Pose2& there, const Eigen::Matrix3d& way_covariance);

/// T_a_b and its covariance in a, given those of T_b_a in b.
PoseGaussian inverse_of(const PoseGaussian& T_b_a);

/// Of x, y, yaw, with the position's axes turned by so much.
Eigen::Matrix3d turned(const Eigen::Matrix3d& matrix, double yaw_rad);

}  // namespace patrol::slam
