#pragma once

#include <vector>

#include <mujoco/mujoco.h>

namespace patrol::sim {

/// What a geom does to a laser's light.
struct SurfaceOptics {
  float reflectivity;  ///< share that it throws back, 0 ... 1: the luminance of its colour (ITU-R BT.709)
  bool is_glass;       ///< of a material whose name says so

  /// Glass returns the beam only within 5 degrees of its normal. `cosine` is that of the angle between the two.
  bool lets_through(double cosine) const { return is_glass && cosine < 0.996; }
};

/// [geom] of the view model.
std::vector<SurfaceOptics> surface_optics(const mjModel& view);

}  // namespace patrol::sim
