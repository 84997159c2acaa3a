#pragma once

#include <cstddef>
#include <vector>

#include "core/frames.h"
#include "localize/amcl/kld.h"
#include "slam/pose_gaussian.h"

namespace patrol::localize {

/// Hypotheses of where the body is. The arrays are parallel, [particle].
struct ParticleCloud {
  std::vector<Pose2> T_map_body;
  std::vector<double> way_scale;    ///< what odometry's way has to be multiplied with, less 1
  std::vector<double> log_weights;  ///< up to a constant that all share

  std::size_t size() const { return T_map_body.size(); }
  void add(const Pose2& pose, double scale, double log_weight = 0.0) {
    T_map_body.push_back(pose), way_scale.push_back(scale), log_weights.push_back(log_weight);
  }
};

/// Which clump of the belief each particle belongs to (PoseBins::clumps).
struct ParticleClumps {
  std::vector<std::size_t> clump_of;  ///< [particle]
  std::size_t heaviest = 0;           ///< the clump of the largest weight
  double heaviest_weight = 0.0;       ///< its share, 0 ... 1
};

/// `weights`: [particle], sum 1.
ParticleClumps find_clumps(const std::vector<Pose2>& T_map_body, const std::vector<double>& weights, const KldSettings& settings);

/// Mean and covariance of the heaviest clump's particles. The mean of the headings is that of their directions.
slam::PoseGaussian gaussian_of(const std::vector<Pose2>& T_map_body, const std::vector<double>& weights, const ParticleClumps& clumps);

}  // namespace patrol::localize
