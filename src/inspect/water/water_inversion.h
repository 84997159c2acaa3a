#pragma once

#include <cstdint>
#include <vector>

#include "core/inspection_result.h"
#include "core/robot_description.h"
#include "inspect/water/water_settings.h"
#include "inspect/water/water_sounding.h"

namespace patrol::inspect {

/// Water ahead of the face from the soundings of one station: one homogeneous sphere in homogeneous rock, or rock alone (core/tem_response.h).
///
/// The posterior of rock, place, radius and the water's conductivity is sampled from prior to likelihood through temperatures that each keep
/// half of the particles' worth (Del Moral, Doucet and Jasra, "Sequential Monte Carlo samplers", J. R. Stat. Soc. B 68, 2006), which gives the evidence
/// on the way; that of rock alone is a sum over its one number. What the soundings tell are the body's decay time, sigma a^2, and its strength,
/// a^3 / R^6: distance and radius are as good as what is known of the water's conductivity (half its relative error in the radius, a quarter
/// in the distance). A body beside or behind the robot would do the same as one ahead: the prior says ahead.
class WaterInversion {
 public:
  explicit WaterInversion(const WaterSettings& settings);

  /// `T_map_body`: where the robot stood, level. `antenna_error_deg` is passed on. Same soundings and seed, same result. Throws InputError for
  /// soundings that do not belong together; without any, the result says so (0 soundings) and nothing else.
  WaterResult invert(const std::vector<AimedSounding>& soundings, const AntennaGeometry& antenna, const Pose2& T_map_body,
                     double antenna_error_deg, std::uint64_t seed) const;

 private:
  WaterSettings settings_;
};

}  // namespace patrol::inspect
