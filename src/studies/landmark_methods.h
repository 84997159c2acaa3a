#pragma once

#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "studies/landmark_world.h"
#include "studies/landmarks/fast_slam.h"
#include "studies/landmarks/landmark_slam.h"

namespace patrol::studies {

/// Landmark SLAM method in the studies.
struct LandmarkMethod {
  std::string name;
  int particles = 0;  ///< 0 for methods without particles
  /// Creates the method with the stated noise of motion and sensor, without the bias.
  std::function<std::unique_ptr<LandmarkSlam>(const LandmarkWorld& world, std::uint64_t seed)> make;
};

/// FastSLAM 1.0 with the stated noise of the odometry scaled.
LandmarkMethod fast_slam_1(int particles, double noise_scale = 1.0);
LandmarkMethod fast_slam_2(int particles);

/// FastSLAM 1.0 in which an optimizer moves the increments, with the resampler of its publication: low-weight
/// optimization for ISCSO, stepwise for IFA.
LandmarkMethod swarm_slam(const std::string& optimizer, int particles);

/// ISCSO+, the best method with sampled poses: improved sand cats with an odometry prior of estimated bias, and
/// unbiased resampling.
LandmarkMethod iscso_plus(int particles);

LandmarkMethod ekf_slam();

/// Invariant EKF that estimates the odometry's bias: the best method, and the default.
LandmarkMethod invariant_slam();

}  // namespace patrol::studies
