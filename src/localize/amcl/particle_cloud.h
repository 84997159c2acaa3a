#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "core/frames.h"
#include "localize/amcl/kld.h"
#include "slam/pose_gaussian.h"

namespace patrol::localize {

/// Set of weighted pose hypotheses. The arrays are parallel, [particle].
struct ParticleCloud {
  std::vector<Pose2> T_map_body;
  std::vector<double> odometry_scale;  ///< scale error of the odometry distance: true / measured - 1
  std::vector<double> log_weights;     ///< log weights up to a constant common to all particles

  std::size_t size() const { return T_map_body.size(); }
  void add(const Pose2& pose, double scale, double log_weight = 0.0) {
    T_map_body.push_back(pose), odometry_scale.push_back(scale), log_weights.push_back(log_weight);
  }
};

/// Clusters of the particles (PoseBins::clusters): [particle] -> cluster number.
std::vector<std::size_t> cluster_particles(const std::vector<Pose2>& T_map_body, const KldSettings& settings);

struct ParticleCluster {
  std::size_t number = 0;
  double weight = 0.0;  ///< sum of the particle weights in the cluster, 0 ... 1
};
/// Finds the cluster of largest weight. `weights`: [particle], sum 1.
ParticleCluster find_dominant_cluster(const std::vector<std::size_t>& clusters, const std::vector<double>& weights);
/// Finds the cluster that continues a pose: the one of largest weight with a particle near it, which is within three
/// standard deviations plus 3 m and 0.9 rad. None if no such cluster has a weight.
std::optional<ParticleCluster> find_cluster_near(const slam::PoseGaussian& pose, const std::vector<Pose2>& T_map_body,
                                                 const std::vector<std::size_t>& clusters,
                                                 const std::vector<double>& weights);

/// Mean and covariance of the particles of one cluster. The mean heading is a circular mean.
slam::PoseGaussian cluster_gaussian(const std::vector<Pose2>& T_map_body, const std::vector<double>& weights,
                                    const std::vector<std::size_t>& clusters, std::size_t cluster);

}  // namespace patrol::localize
