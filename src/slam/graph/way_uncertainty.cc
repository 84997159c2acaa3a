#include "slam/graph/way_uncertainty.h"

#include <Eigen/Geometry>

#include <cmath>
#include <limits>
#include <queue>
#include <utility>

namespace patrol::slam {
namespace {

constexpr double kMetresPerRadian = 10.0;

double uncertainty(const Eigen::Matrix3d& covariance) { return covariance(0, 0) + covariance(1, 1) + kMetresPerRadian * kMetresPerRadian * covariance(2, 2); }

}  // namespace

Eigen::Matrix3d carried_on(const PoseGaussian& here, const Pose2& there, const Eigen::Matrix3d& way_covariance) {
  Eigen::Matrix3d F = Eigen::Matrix3d::Identity();
  F(0, 2) = -(there.y - here.mean.y);
  F(1, 2) = there.x - here.mean.x;
  return F * here.covariance * F.transpose() + turned(way_covariance, here.mean.yaw);
}

Eigen::Matrix3d turned(const Eigen::Matrix3d& matrix, double yaw_rad) {
  Eigen::Matrix3d R = Eigen::Matrix3d::Identity();
  R.topLeftCorner<2, 2>() = Eigen::Rotation2Dd(yaw_rad).toRotationMatrix();
  return R * matrix * R.transpose();
}

PoseGaussian inverse_of(const PoseGaussian& T_b_a) {
  const Pose2 inverse = T_b_a.mean.inverse();
  const double c = std::cos(T_b_a.mean.yaw), s = std::sin(T_b_a.mean.yaw);
  const Eigen::Matrix3d J = (Eigen::Matrix3d() << -c, -s, inverse.y, s, -c, -inverse.x, 0.0, 0.0, -1.0).finished();
  return {.mean = inverse, .covariance = J * T_b_a.covariance * J.transpose()};
}

std::vector<PoseGaussian> positions_from(int place, const std::vector<Pose2>& T_map_place, const std::vector<UncertainWay>& ways) {
  std::vector<std::vector<std::pair<int, const Eigen::Matrix3d*>>> next(T_map_place.size());
  for (const UncertainWay& way : ways) {
    next[static_cast<std::size_t>(way.from)].emplace_back(way.to, &way.covariance);
    next[static_cast<std::size_t>(way.to)].emplace_back(way.from, &way.covariance);
  }
  const double infinity = std::numeric_limits<double>::infinity();
  const Pose2 T_place_map = T_map_place[static_cast<std::size_t>(place)].inverse();
  std::vector<PoseGaussian> found;
  for (const Pose2& T_map_there : T_map_place) found.push_back({.mean = T_place_map * T_map_there, .covariance = Eigen::Vector3d::Constant(infinity).asDiagonal()});
  found[static_cast<std::size_t>(place)].covariance.setZero();

  using Entry = std::pair<double, int>;
  std::priority_queue<Entry, std::vector<Entry>, std::greater<>> queue;
  queue.push({0.0, place});
  while (!queue.empty()) {
    const auto [known, at] = queue.top();
    queue.pop();
    const PoseGaussian here = found[static_cast<std::size_t>(at)];
    if (known > uncertainty(here.covariance)) continue;
    for (const auto& [to, covariance] : next[static_cast<std::size_t>(at)]) {
      PoseGaussian& there = found[static_cast<std::size_t>(to)];
      const Eigen::Matrix3d carried = carried_on(here, there.mean, *covariance);
      if (uncertainty(carried) >= uncertainty(there.covariance)) continue;
      there.covariance = carried;
      queue.push({uncertainty(carried), to});
    }
  }
  return found;
}

}  // namespace patrol::slam
