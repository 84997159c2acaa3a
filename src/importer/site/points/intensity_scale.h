#pragma once

#include <string>
#include <vector>

#include "core/sensors/registry.h"

namespace patrol::importer {

/// Linear map from intensities to the light of a surface, reflectivity times cosine of incidence.
struct IntensityScale {
  float factor = 0.0f;  ///< 0: the points have no intensity
  std::string rule;     ///< text for the table of assumptions
  float black = 0.0f;   ///< intensity of a black surface

  bool is_known() const { return factor > 0.0f; }
  /// Returns the light for an intensity, in [0, 1].
  float light_of(float intensity) const;
};

/// Returns the scale by the largest intensity: its full scale is 1, 255 or 65535, or the largest value above that.
IntensityScale scale_of(float largest);

/// Returns the scale of a cloud of any instrument, whose full scale is unknown: if 99 % of the intensities are in the
/// lower half of the scale by the largest one, the brightest of these are white. With negative intensities, the
/// smallest one is black.
IntensityScale scale_of_cloud(const std::vector<ScannerPoint>& points);

}  // namespace patrol::importer
