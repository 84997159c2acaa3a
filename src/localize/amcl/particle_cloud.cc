#include "localize/amcl/particle_cloud.h"

#include <algorithm>
#include <cmath>

namespace patrol::localize {

ParticleClumps find_clumps(const std::vector<Pose2>& T_map_body, const std::vector<double>& weights, const KldSettings& settings) {
  ParticleClumps found;
  PoseBins bins(settings);
  found.clump_of.reserve(T_map_body.size());
  for (const Pose2& pose : T_map_body) found.clump_of.push_back(bins.add(pose));

  const std::vector<std::size_t> clumps = bins.clumps();
  std::vector<double> weight_of(bins.size(), 0.0);
  for (std::size_t i = 0; i < T_map_body.size(); ++i) {
    found.clump_of[i] = clumps[found.clump_of[i]];
    weight_of[found.clump_of[i]] += weights[i];
  }
  const auto heaviest = std::max_element(weight_of.begin(), weight_of.end());
  found.heaviest = static_cast<std::size_t>(heaviest - weight_of.begin());
  found.heaviest_weight = *heaviest;
  return found;
}

slam::PoseGaussian gaussian_of(const std::vector<Pose2>& T_map_body, const std::vector<double>& weights, const ParticleClumps& clumps) {
  const auto for_each_member = [&](auto&& visit) {
    for (std::size_t i = 0; i < T_map_body.size(); ++i) {
      if (clumps.clump_of[i] == clumps.heaviest) visit(T_map_body[i], weights[i]);
    }
  };
  double sum = 0.0, x = 0.0, y = 0.0, c = 0.0, s = 0.0;
  for_each_member([&](const Pose2& pose, double weight) {
    sum += weight, x += weight * pose.x, y += weight * pose.y;
    c += weight * std::cos(pose.yaw), s += weight * std::sin(pose.yaw);
  });
  slam::PoseGaussian gaussian{.mean = {x / sum, y / sum, std::atan2(s, c)}};
  for_each_member([&](const Pose2& pose, double weight) {
    const Eigen::Vector3d offset = gaussian.offset_of(pose);
    gaussian.covariance += weight / sum * offset * offset.transpose();
  });
  return gaussian;
}

}  // namespace patrol::localize
