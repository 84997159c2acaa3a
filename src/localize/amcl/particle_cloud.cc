#include "localize/amcl/particle_cloud.h"

#include <algorithm>
#include <cmath>

#include <Eigen/LU>

namespace patrol::localize {
namespace {

constexpr double kNearSigmas = 3.0;
const Eigen::Vector3d kNearStd(1.0, 1.0, 0.3);  // m, m, rad: added to the standard deviations of a pose
constexpr double kMinClusterWeight = 1e-9;

std::vector<double> weights_of_clusters(const std::vector<std::size_t>& clusters, const std::vector<double>& weights) {
  std::vector<double> sums(clusters.size(), 0.0);
  for (std::size_t i = 0; i < clusters.size(); ++i) sums[clusters[i]] += weights[i];
  return sums;
}

}  // namespace

std::vector<std::size_t> cluster_particles(const std::vector<Pose2>& T_map_body, const KldSettings& settings) {
  PoseBins bins(settings);
  std::vector<std::size_t> clusters;
  clusters.reserve(T_map_body.size());
  for (const Pose2& pose : T_map_body) clusters.push_back(bins.add(pose));
  const std::vector<std::size_t> cluster_of_bin = bins.clusters();
  for (std::size_t& cluster : clusters) cluster = cluster_of_bin[cluster];
  return clusters;
}

ParticleCluster find_dominant_cluster(const std::vector<std::size_t>& clusters, const std::vector<double>& weights) {
  const std::vector<double> sums = weights_of_clusters(clusters, weights);
  const auto dominant = std::max_element(sums.begin(), sums.end());
  return {.number = static_cast<std::size_t>(dominant - sums.begin()), .weight = *dominant};
}

std::optional<ParticleCluster> find_cluster_near(const slam::PoseGaussian& pose, const std::vector<Pose2>& T_map_body,
                                                 const std::vector<std::size_t>& clusters,
                                                 const std::vector<double>& weights) {
  const std::vector<double> sums = weights_of_clusters(clusters, weights);
  Eigen::Matrix3d covariance = pose.covariance;
  covariance.diagonal() += kNearStd.cwiseAbs2();
  const Eigen::Matrix3d information = covariance.inverse();
  std::optional<ParticleCluster> nearest;
  for (std::size_t i = 0; i < T_map_body.size(); ++i) {
    const double weight = sums[clusters[i]];
    if (weight < kMinClusterWeight || (nearest && weight <= nearest->weight)) continue;
    const Eigen::Vector3d offset = pose.residual_to_mean(T_map_body[i]);
    if (offset.dot(information * offset) <= kNearSigmas * kNearSigmas)
      nearest = {.number = clusters[i], .weight = weight};
  }
  return nearest;
}

slam::PoseGaussian cluster_gaussian(const std::vector<Pose2>& T_map_body, const std::vector<double>& weights,
                                    const std::vector<std::size_t>& clusters, std::size_t cluster) {
  const auto for_each_member = [&](auto&& visit) {
    for (std::size_t i = 0; i < T_map_body.size(); ++i) {
      if (clusters[i] == cluster) visit(T_map_body[i], weights[i]);
    }
  };
  double sum = 0.0, x = 0.0, y = 0.0, c = 0.0, s = 0.0;
  for_each_member([&](const Pose2& pose, double weight) {
    sum += weight, x += weight * pose.x, y += weight * pose.y;
    c += weight * std::cos(pose.yaw), s += weight * std::sin(pose.yaw);
  });
  slam::PoseGaussian gaussian{.mean = {x / sum, y / sum, std::atan2(s, c)}};
  for_each_member([&](const Pose2& pose, double weight) {
    const Eigen::Vector3d offset = gaussian.residual_to_mean(pose);
    gaussian.covariance += weight / sum * offset * offset.transpose();
  });
  return gaussian;
}

}  // namespace patrol::localize
