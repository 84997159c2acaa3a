#pragma once

#include <Eigen/Core>

#include <vector>

#include "core/frames.h"
#include "core/sensors/registry.h"
#include "core/settings.h"

namespace patrol::plan {

struct SonarConeSettings {
  double max_range_m = 1.2;     ///< echoes from farther away are left out: the arc is too wide to mean anything
  double fov_share = 0.7;       ///< of the cone in which the echo is believed to lie
  double ground_share = 0.85;   ///< an echo from beyond this share of the way to where the cone meets the ground may be it

  template <typename Self, typename Visitor>
  static void fields(Self& self, Visitor& visit) {
    visit("max_range_m", self.max_range_m, between(0.2, 5.0));
    visit("fov_share", self.fov_share, between(0.1, 1.0));
    visit("ground_share", self.ground_share, between(0.1, 10.0));
  }
};

/// What a ping says, as places in level: an arc on which something may lie, and ground nearer on which nothing does. Points lie
/// no more than half of `spacing_m` apart.
struct SonarCone {
  std::vector<Eigen::Vector2d> arc_m;
  std::vector<Eigen::Vector2d> free_m;
};

/// The inverse sensor model of a sonar (Moravec and Elfes, "High resolution maps from wide angle sonar", 1985), reduced to
/// yes and no: the echo lies somewhere on the arc; nothing lies nearer. A reading without echo frees the cone as far as
/// `max_range_m`; one that was too near puts the arc at the least range. `body_height_m`: of level's origin above the ground.
SonarCone find_sonar_cone(const SonarConeSettings& settings, const UltrasonicRange& ping, const Pose3& T_level_transducer,
                          double body_height_m, double spacing_m);

}  // namespace patrol::plan
