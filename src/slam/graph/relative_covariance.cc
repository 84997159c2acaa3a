#include "slam/graph/relative_covariance.h"

#include <cmath>
#include <limits>
#include <queue>
#include <utility>

#include <Eigen/Geometry>

namespace patrol::slam {
namespace {

constexpr double kMetersPerRadian = 10.0;

double uncertainty(const Eigen::Matrix3d& covariance) {
  return covariance(0, 0) + covariance(1, 1) + kMetersPerRadian * kMetersPerRadian * covariance(2, 2);
}

}  // namespace

Eigen::Matrix3d compose_covariance(const PoseGaussian& here, const Pose2& there,
                                   const Eigen::Matrix3d& edge_covariance) {
  Eigen::Matrix3d F = Eigen::Matrix3d::Identity();
  F(0, 2) = -(there.y - here.mean.y);
  F(1, 2) = there.x - here.mean.x;
  return F * here.covariance * F.transpose() + rotate_covariance(edge_covariance, here.mean.yaw);
}

Eigen::Matrix3d rotate_covariance(const Eigen::Matrix3d& matrix, double yaw_rad) {
  Eigen::Matrix3d R = Eigen::Matrix3d::Identity();
  R.topLeftCorner<2, 2>() = Eigen::Rotation2Dd(yaw_rad).toRotationMatrix();
  return R * matrix * R.transpose();
}

PoseGaussian invert(const PoseGaussian& T_b_a) {
  const Pose2 inverse = T_b_a.mean.inverse();
  const double c = std::cos(T_b_a.mean.yaw), s = std::sin(T_b_a.mean.yaw);
  const Eigen::Matrix3d J = (Eigen::Matrix3d() << -c, -s, inverse.y, s, -c, -inverse.x, 0.0, 0.0, -1.0).finished();
  return {.mean = inverse, .covariance = J * T_b_a.covariance * J.transpose()};
}

std::vector<PoseGaussian> shortest_path_distributions(int node, const std::vector<Pose2>& T_map_node,
                                                      const std::vector<CovarianceEdge>& covariance_edges) {
  std::vector<std::vector<std::pair<int, const Eigen::Matrix3d*>>> next(T_map_node.size());
  for (const CovarianceEdge& edge : covariance_edges) {
    next[static_cast<std::size_t>(edge.from)].emplace_back(edge.to, &edge.covariance);
    next[static_cast<std::size_t>(edge.to)].emplace_back(edge.from, &edge.covariance);
  }
  const double infinity = std::numeric_limits<double>::infinity();
  const Pose2 T_node_map = T_map_node[static_cast<std::size_t>(node)].inverse();
  std::vector<PoseGaussian> found;
  for (const Pose2& T_map_there : T_map_node)
    found.push_back({.mean = T_node_map * T_map_there, .covariance = Eigen::Vector3d::Constant(infinity).asDiagonal()});
  found[static_cast<std::size_t>(node)].covariance.setZero();

  using Entry = std::pair<double, int>;
  std::priority_queue<Entry, std::vector<Entry>, std::greater<>> queue;
  queue.push({0.0, node});
  while (!queue.empty()) {
    const auto [cost, at] = queue.top();
    queue.pop();
    const PoseGaussian here = found[static_cast<std::size_t>(at)];
    if (cost > uncertainty(here.covariance)) continue;
    for (const auto& [to, covariance] : next[static_cast<std::size_t>(at)]) {
      PoseGaussian& there = found[static_cast<std::size_t>(to)];
      const Eigen::Matrix3d composed = compose_covariance(here, there.mean, *covariance);
      if (uncertainty(composed) >= uncertainty(there.covariance)) continue;
      there.covariance = composed;
      queue.push({uncertainty(composed), to});
    }
  }
  return found;
}

}  // namespace patrol::slam
