#pragma once

#include <cstdint>

#include "core/frames.h"
#include "core/random.h"
#include "core/settings.h"
#include "localize/amcl/particle_cloud.h"
#include "slam/motion_model.h"
#include "slam/pose_gaussian.h"

namespace patrol::localize {

struct OdometryModelSettings {
  double way_scale_std = 0.02;        ///< of an error of the way's length that lasts: track wear, steady slip
  double way_scale_memory_m = 50.0;   ///< the way over which it becomes another
  slam::MotionModelSettings noise;    ///< what is new in every step

  template <typename Self, typename Visitor>
  static void fields(Self& self, Visitor& visit) {
    visit("way_scale_std", self.way_scale_std, between(0.0, 0.5));
    visit("way_scale_memory_m", self.way_scale_memory_m, between(0.1, 1e6));
    visit("noise", self.noise);
  }
};

/// Moves every particle by what odometry has seen, T_before_now in `dt_s`, and draws its error.
///
/// slam/motion_model.h says how large a step's own error is. It is not all: an error of scale is the same in step after
/// step, so that in a corridor without features the belief has to widen with the way and not with its root, as it does
/// when every step errs anew. So each particle carries its own scale (a Gauss-Markov process over the way), and what
/// ranges and features say about positions tells the scales apart too.
void move_particles(ParticleCloud& cloud, const Pose2& T_before_now, double dt_s, const OdometryModelSettings& settings,
                    const RandomStream& noise, std::uint64_t tick);

/// The same for a normally distributed pose whose scale is not known better than at the start.
slam::PoseGaussian moved(const slam::PoseGaussian& before, const Pose2& T_before_now, double dt_s, const OdometryModelSettings& settings);

}  // namespace patrol::localize
