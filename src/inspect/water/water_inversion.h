#pragma once

#include <cstdint>
#include <vector>

#include "core/inspection_result.h"
#include "core/robot_description.h"
#include "inspect/water/water_settings.h"
#include "inspect/water/water_sounding.h"

namespace patrol::inspect {

/// Inversion of the soundings of one station for water ahead of the face. The models are one homogeneous sphere in
/// homogeneous rock, and rock alone (core/sensors/tem_response.h).
///
/// The posterior of rock conductivity, position, radius and water conductivity is sampled with a sequential Monte Carlo
/// sampler [DelMoral06]. It tempers from prior to likelihood; each temperature keeps half of the effective sample size.
/// The sampler also yields the evidence; that of rock alone is a one-dimensional sum. The soundings constrain the decay
/// time of the body, sigma a^2, and its strength, a^3 / R^6. The accuracy of distance and radius therefore depends on
/// that of the water conductivity: half its relative error in the radius, a quarter in the distance. A body beside or
/// behind the robot is indistinguishable from one ahead; the prior excludes it.
class WaterInversion {
 public:
  explicit WaterInversion(const WaterSettings& settings);

  /// Estimates the water body. `T_map_body`: pose of the robot. `antenna_error_deg` is copied to the result. The result
  /// is a deterministic function of soundings and seed. Throws InputError for inconsistent soundings. Without soundings
  /// the result contains only their number, zero.
  WaterResult invert(const std::vector<OrientedSounding>& soundings, const AntennaGeometry& antenna,
                     const Pose2& T_map_body, double antenna_error_deg, std::uint64_t seed) const;

 private:
  WaterSettings settings_;
};

}  // namespace patrol::inspect
