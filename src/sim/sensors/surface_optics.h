#pragma once

#include <string>
#include <vector>

#include <mujoco/mujoco.h>

namespace patrol::sim {

/// Optical properties of a geom for laser light.
struct SurfaceOptics {
  float reflectivity;  ///< reflectivity, 0 ... 1: luminance of the color (ITU-R BT.709)
  bool is_glass;       ///< true for materials with "glass" in the name

  /// Returns whether the beam passes through: glass returns it only within 5 degrees of its normal. `cosine` is that of
  /// the angle of incidence.
  bool is_transparent_at(double cosine) const { return is_glass && cosine < 0.996; }
};

/// Returns whether the name of a geom or of its material contains one of the words; an empty word is in no name.
bool is_named_after(const mjModel& view, int geom, const std::vector<std::string>& words);

/// Returns the optical properties, [geom] of the view model.
std::vector<SurfaceOptics> surface_optics(const mjModel& view);

}  // namespace patrol::sim
