#include "localize/amcl/particle_cloud.h"

#include <algorithm>
#include <cmath>

namespace patrol::localize {

std::vector<std::size_t> clumps_of(const std::vector<Pose2>& T_map_body, const KldSettings& settings) {
  PoseBins bins(settings);
  std::vector<std::size_t> clumps;
  clumps.reserve(T_map_body.size());
  for (const Pose2& pose : T_map_body) clumps.push_back(bins.add(pose));
  const std::vector<std::size_t> clump_of_bin = bins.clumps();
  for (std::size_t& clump : clumps) clump = clump_of_bin[clump];
  return clumps;
}

HeaviestClump heaviest_clump(const std::vector<std::size_t>& clumps, const std::vector<double>& weights) {
  std::vector<double> weight_of(clumps.size(), 0.0);
  for (std::size_t i = 0; i < clumps.size(); ++i) weight_of[clumps[i]] += weights[i];
  const auto heaviest = std::max_element(weight_of.begin(), weight_of.end());
  return {.number = static_cast<std::size_t>(heaviest - weight_of.begin()), .weight = *heaviest};
}

slam::PoseGaussian gaussian_of(const std::vector<Pose2>& T_map_body, const std::vector<double>& weights,
                               const std::vector<std::size_t>& clumps, std::size_t clump) {
  const auto for_each_member = [&](auto&& visit) {
    for (std::size_t i = 0; i < T_map_body.size(); ++i) {
      if (clumps[i] == clump) visit(T_map_body[i], weights[i]);
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
