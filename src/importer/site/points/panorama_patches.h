#pragma once

#include <functional>
#include <vector>

#include "importer/site/points/panorama.h"
#include "importer/site/points/patch.h"

namespace patrol::importer {

/// Settings of the surfaces of panoramas.
struct PanoramaPatchSettings {
  double max_residual_m = 0.005;        ///< largest distance of a point from its patch near the scanner
  double max_residual_per_m = 0.0003;   ///< additional distance per meter of range, for errors of the angles
  double max_reflectivity_step = 0.12;  ///< largest difference of the reflectivities of two patches that are joined
  double silhouette_px = 0.3;           ///< width of the outer half of a pixel where the surface ends. The union of
                                        ///< several scans would be too wide with half a pixel
  double end_overlap_m = 0.003;         ///< length on the surface by which patches extend where it ends
  double overlap_m = 0.01;  ///< length on the surface by which patches extend where it continues, against gaps seen
                            ///< from other directions
};

/// Returns flat patches of the usable pixels that no other scan covers: the largest aligned squares of pixels on
/// one plane, joined to rectangles. A pixel is the piece of the surface within its beam's angles; lone pixels face the
/// scanner. `reflectivity`: of an intensity and the cosine of incidence.
std::vector<Patch> patches_of(const Panorama& scan, const PanoramaPatchSettings& settings,
                              const std::function<float(float intensity, double cosine)>& reflectivity);

}  // namespace patrol::importer
