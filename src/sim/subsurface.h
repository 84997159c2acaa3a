#pragma once

#include <vector>

#include "core/settings.h"

namespace patrol::sim {

/// Cave or karst conduit filled with water or mud, as a sphere, in world.
struct WaterBodySettings {
  double x_m = 0.0;
  double y_m = 0.0;
  double z_m = 0.0;
  double radius_m = 6.0;
  double conductivity_spm = 0.6;  ///< fresh karst water: 0.05; mud and mineralized water: 0.3 to 1

  template <typename Self, typename Visitor>
  static void fields(Self& self, Visitor& visit) {
    visit("x_m", self.x_m);
    visit("y_m", self.y_m);
    visit("z_m", self.z_m);
    visit("radius_m", self.radius_m, between(0.5, 30.0));
    visit("conductivity_spm", self.conductivity_spm, between(0.01, 5.0));
  }
};

struct RockSettings {
  double conductivity_spm = 0.003;  ///< limestone: 0.0005 to 0.005

  template <typename Self, typename Visitor>
  static void fields(Self& self, Visitor& visit) {
    visit("conductivity_spm", self.conductivity_spm, between(1e-4, 0.1));
  }
};

/// Subsurface ahead of the tunnel face.
struct Subsurface {
  RockSettings rock;
  std::vector<WaterBodySettings> water_bodies;
};

}  // namespace patrol::sim
