#pragma once

#include <mujoco/mujoco.h>

#include "core/settings.h"

namespace patrol::render {

/// Brightness of a replay's pictures. No sensor depends on it: lidar and depth camera have their own infrared light.
struct LightSettings {
  double intensity = 1.0;  ///< fraction of the light of the world's lamps, sun and sky

  template <typename Self, typename Visitor>
  static void fields(Self& self, Visitor& visit) {
    visit("intensity", self.intensity, between(0.0, 1.0));
  }
};

/// Dims lamps, emission, sky and fog. A fraction s of the light becomes s^(1/2.2) of the brightness in the picture
/// (gamma of sRGB). Must be called before the model's textures are uploaded.
void set_light(mjModel& view, const LightSettings& light);

}  // namespace patrol::render
