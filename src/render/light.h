#pragma once

#include <mujoco/mujoco.h>

#include "core/settings.h"

namespace patrol::render {

/// How bright it is, for the eye that watches a replay. No sensor of the robots needs the light: lidar and depth camera bring
/// their own, which is infrared.
struct LightSettings {
  double brightness_share = 1.0;  ///< of the brightness that the world's lamps, sun and sky have in the picture

  template <typename Self, typename Visitor>
  static void fields(Self& self, Visitor& visit) {
    visit("brightness_share", self.brightness_share, between(0.0, 1.0));
  }
};

/// Dims what shines and glows, the sky, and the fog, which has its light from them. For a model whose textures have not been
/// uploaded yet.
void set_light(mjModel& view, const LightSettings& light);

}  // namespace patrol::render
