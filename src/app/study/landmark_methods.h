#pragma once

#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "app/study/landmark_world.h"
#include "slam/landmarks/fast_slam.h"
#include "slam/landmarks/landmark_slam.h"

namespace patrol::app {

/// A method of SLAM on landmarks as the studies compare it.
struct LandmarkMethod {
  std::string name;
  int particles = 0;  ///< 0: it has none
  /// What the robot is told of the world: the motion's and the sensor's stated noise, and no bias.
  std::function<std::unique_ptr<slam::LandmarkSlam>(const LandmarkWorld& world, std::uint64_t seed)> make;
};

/// FastSLAM 1.0 with odometry's stated noise multiplied.
LandmarkMethod fast_slam_1(int particles, double noise_scale = 1.0);
LandmarkMethod fast_slam_2(int particles);

/// FastSLAM 1.0 whose increments an optimiser moves, with the resampler that its paper gives it: ISCSO low-weight optimisation, IFA stepwise.
LandmarkMethod swarm_slam(const std::string& optimizer, int particles);

/// ISCSO+, our best with sampled poses: the improved sand cats, held to odometry by a prior with a learnt bias, and resampled without bias.
LandmarkMethod learning_sand_cats(int particles);

LandmarkMethod ekf_slam();

/// Our best, and the default: an invariant filter that estimates odometry's bias.
LandmarkMethod invariant_slam();

}  // namespace patrol::app
