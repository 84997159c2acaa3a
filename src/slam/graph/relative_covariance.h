#pragma once

#include <vector>

#include "slam/pose_gaussian.h"

namespace patrol::slam {

/// Undirected edge between two nodes with the covariance of their relative pose.
struct CovarianceEdge {
  int from = 0;
  int to = 0;
  /// Covariance of x, y, yaw of `to` in the frame of `from`; m, m, rad.
  Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();
};

/// Relative poses and covariances of all nodes in the frame of `node`, [node]. Each covariance is that along the path
/// of minimum uncertainty, found by Dijkstra's search. It is an upper bound of the marginal covariance of the whole
/// graph [Olson08, section 4.2]. The uncertainty of a path counts one radian as ten meters. Unreachable nodes have
/// infinite covariance.
std::vector<PoseGaussian> shortest_path_distributions(int node, const std::vector<Pose2>& T_map_node,
                                                      const std::vector<CovarianceEdge>& covariance_edges);

/// Propagates the covariance of `here` along an edge to `there`. `edge_covariance` is in the frame of `here`; the poses
/// and the result are in one common frame.
Eigen::Matrix3d compose_covariance(const PoseGaussian& here, const Pose2& there,
                                   const Eigen::Matrix3d& edge_covariance);

/// Inverts T_b_a with its covariance in b to T_a_b with its covariance in a.
PoseGaussian invert(const PoseGaussian& T_b_a);

/// Rotates the position axes of a matrix of x, y, yaw by `yaw_rad`.
Eigen::Matrix3d rotate_covariance(const Eigen::Matrix3d& matrix, double yaw_rad);

}  // namespace patrol::slam
