#pragma once

#include <cmath>

#include "core/settings.h"

namespace patrol::sim {

/// Airborne dust, for optical sensors. Sound of 8 mm and radio waves of 7 cm wavelength are not affected by grains of
/// micrometers.
struct DustSettings {
  bool enabled = false;        ///< presence of dust in the air
  double visibility_m = 50.0;  ///< meteorological range: distance at which the contrast of black against the sky falls
                               ///< to 2 %
  double backscatter_probability =
      0.05;  ///< probability that extinguished light causes a return that a lidar takes for a surface

  template <typename Self, typename Visitor>
  static void fields(Self& self, Visitor& visit) {
    visit("enabled", self.enabled);
    visit("visibility_m", self.visibility_m, between(0.5, 100000.0));
    visit("backscatter_probability", self.backscatter_probability, between(0.0, 1.0));
  }

  /// Returns the extinction coefficient (Koschmieder: ln 50 / visibility); 0 in clear air.
  double extinction_per_m() const { return enabled ? std::log(50.0) / visibility_m : 0.0; }

  /// Returns the distance in clear air from which a surface returns as little light as from `distance_m` in dust. Both
  /// fall with the square of the distance, in dust also with exp(-extinction) each way.
  double equivalent_clear_distance_m(double distance_m) const {
    return distance_m * std::exp(extinction_per_m() * distance_m);
  }
};

}  // namespace patrol::sim
