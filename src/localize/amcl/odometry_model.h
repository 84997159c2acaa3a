#pragma once

#include <cstdint>

#include "core/frames.h"
#include "core/random.h"
#include "localize/amcl/odometry_model_settings.h"
#include "localize/amcl/particle_cloud.h"
#include "slam/motion_model.h"
#include "slam/pose_gaussian.h"

namespace patrol::localize {

/// Propagates all particles by the odometry increment T_before_now over `dt_s`, with sampled errors.
///
/// slam/motion_model.h gives the independent error of a step. Scale errors, in contrast, persist over many steps. In a
/// featureless corridor the standard deviation must therefore grow with the distance, not with its square root. Each
/// particle therefore has its own scale error (a Gauss-Markov process over the distance), which ranges and features
/// also estimate.
void propagate_particles(ParticleCloud& cloud, const Pose2& T_before_now, double dt_s,
                         const OdometryModelSettings& settings, const RandomStream& noise, std::uint64_t tick);

/// Propagates a normally distributed pose by an odometry increment, with the stationary distribution of the scale
/// error.
slam::PoseGaussian predict(const slam::PoseGaussian& before, const Pose2& T_before_now, double dt_s,
                           const OdometryModelSettings& settings);

}  // namespace patrol::localize
