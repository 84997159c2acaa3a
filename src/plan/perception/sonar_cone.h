#pragma once

#include <Eigen/Core>

#include <vector>

#include "core/frames.h"
#include "core/sensors/registry.h"
#include "core/settings.h"

namespace patrol::plan {

struct SonarConeSettings {
  double max_range_m = 1.2;     ///< maximum range of an echo: beyond, the arc is too wide to be useful
  double fov_fraction = 0.7;       ///< fraction of the cone's width in which the echo is assumed to lie
  double ground_range_fraction = 0.85;   ///< fraction of the range to level ground from which an echo may be ground

  template <typename Self, typename Visitor>
  static void fields(Self& self, Visitor& visit) {
    visit("max_range_m", self.max_range_m, between(0.2, 5.0));
    visit("fov_fraction", self.fov_fraction, between(0.1, 1.0));
    visit("ground_range_fraction", self.ground_range_fraction, between(0.1, 10.0));
  }
};

/// Arc on which the echo of a ping may lie, and free ground before it, in level. Points are at most half of `spacing_m`
/// apart.
struct SonarCone {
  std::vector<Eigen::Vector2d> arc_m;
  std::vector<Eigen::Vector2d> free_m;
};

/// Computes the inverse sensor model of a sonar [Moravec85], reduced to binary evidence: the echo lies somewhere on the
/// arc, nothing lies nearer. A reading without echo clears the cone up to `max_range_m`. A reading below the minimum
/// range puts the arc at the minimum range; NaN yields no points. `body_height_m`: height of level's origin above the
/// ground.
SonarCone inverse_sonar_model(const SonarConeSettings& settings, const UltrasonicRange& ping, const Pose3& T_level_transducer,
                          double body_height_m, double spacing_m);

}  // namespace patrol::plan
