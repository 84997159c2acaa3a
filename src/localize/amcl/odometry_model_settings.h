#pragma once

#include "core/settings.h"
#include "slam/motion_model_settings.h"

namespace patrol::localize {

/// Settings of the motion model of the particles (odometry_model.h).
struct OdometryModelSettings {
  /// Standard deviation of the persistent scale error of odometry's distance: track wear, steady slip.
  double scale_std = 0.02;
  double scale_correlation_length_m = 50.0;  ///< correlation length of the scale error of odometry's distance
  slam::MotionModelSettings noise;           ///< independent errors of an odometry step

  template <typename Self, typename Visitor>
  static void fields(Self& self, Visitor& visit) {
    visit("scale_std", self.scale_std, between(0.0, 0.5));
    visit("scale_correlation_length_m", self.scale_correlation_length_m, between(0.1, 1e6));
    visit("noise", self.noise);
  }
};

}  // namespace patrol::localize
