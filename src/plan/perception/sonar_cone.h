#pragma once

#include <vector>

#include <Eigen/Core>

#include "core/frames.h"
#include "core/sensors/registry.h"
#include "core/settings.h"
#include "plan/perception/sonar_cone_settings.h"

namespace patrol::plan {

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
SonarCone inverse_sonar_model(const SonarConeSettings& settings, const UltrasonicRange& ping,
                              const Pose3& T_level_transducer, double body_height_m, double spacing_m);

}  // namespace patrol::plan
