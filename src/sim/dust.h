#pragma once

#include <cmath>

#include "core/settings.h"

namespace patrol::sim {

/// Dust in the air, for sensors of light. Sound of 8 mm and radio waves of 7 cm do not see grains of micrometres.
struct DustSettings {
  bool enabled = false;
  double visibility_m = 50.0;  ///< meteorological range: where the contrast of black against the sky falls to 2 %
  double echo_share = 0.05;    ///< of the light that is stopped: chance that it makes an echo which a lidar takes for a surface

  template <typename Self, typename Visitor>
  static void fields(Self& self, Visitor& visit) {
    visit("enabled", self.enabled);
    visit("visibility_m", self.visibility_m, between(0.5, 100000.0));
    visit("echo_share", self.echo_share, between(0.0, 1.0));
  }

  /// Share of light stopped, per metre (Koschmieder: ln 50 / visibility); 0 in clear air.
  double extinction_per_m() const { return enabled ? std::log(50.0) / visibility_m : 0.0; }

  /// Light that goes to a surface and back is as weak as from a surface this far away in clear air: both fall with the square
  /// of the distance, in dust also by exp(-extinction) there and back.
  double clear_distance_m(double distance_m) const { return distance_m * std::exp(extinction_per_m() * distance_m); }
};

}  // namespace patrol::sim
