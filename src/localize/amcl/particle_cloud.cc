#include "localize/amcl/particle_cloud.h"

#include <algorithm>
#include <cmath>

namespace patrol::localize {

std::vector<std::size_t> cluster_particles(const std::vector<Pose2>& T_map_body, const KldSettings& settings) {
  PoseBins bins(settings);
  std::vector<std::size_t> clusters;
  clusters.reserve(T_map_body.size());
  for (const Pose2& pose : T_map_body) clusters.push_back(bins.add(pose));
  const std::vector<std::size_t> cluster_of_bin = bins.clusters();
  for (std::size_t& cluster : clusters) cluster = cluster_of_bin[cluster];
  return clusters;
}

DominantCluster find_dominant_cluster(const std::vector<std::size_t>& clusters, const std::vector<double>& weights) {
  std::vector<double> cluster_weights(clusters.size(), 0.0);
  for (std::size_t i = 0; i < clusters.size(); ++i) cluster_weights[clusters[i]] += weights[i];
  const auto dominant = std::max_element(cluster_weights.begin(), cluster_weights.end());
  return {.number = static_cast<std::size_t>(dominant - cluster_weights.begin()), .weight = *dominant};
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
