#pragma once

#include <mujoco/mujoco.h>

#include "core/settings.h"

namespace patrol::render {

/// How bright it is, for the eye that watches a replay. No sensor of the robots needs the light: lidar and depth camera bring
/// their own, which is infrared.
struct LightSettings {
  double brightness_share = 1.0;  ///< of the light that the world's lamps, sun and sky give

  template <typename Self, typename Visitor>
  static void fields(Self& self, Visitor& visit) {
    visit("brightness_share", self.brightness_share, between(0.0, 1.0));
  }
};

/// Dims what shines and glows, the sky, and the fog, which has its light from them. To the eye, and so in a picture, a share s of
/// the light is s^(1/2.2) of the brightness (sRGB's gamma): at a third of the light one still sees well. For a model whose
/// textures have not been uploaded yet.
void set_light(mjModel& view, const LightSettings& light);

}  // namespace patrol::render
