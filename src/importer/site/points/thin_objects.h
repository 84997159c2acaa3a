#pragma once

#include <vector>

#include "importer/site/points/patch.h"
#include "importer/site/points/scanned_ground.h"

namespace patrol::importer {

struct ThinObjectSettings {
  double layer_m = 0.4;            ///< height of the layers
  double cell_m = 0.05;            ///< cells that connect surfaces within a layer
  double max_extent_m = 0.6;       ///< largest extent of a thin object along x and y
  double lowest_m = 0.02;          ///< lowest height above the ground
  double highest_m = 8.0;          ///< highest height above the ground
  double inset_m = 0.004;          ///< distance of the filled-in sides behind the measured ones
  float max_spacing_ratio = 4.0f;  ///< largest ratio of the distances of beams in an outline
};

/// Closes posts and other thin objects whose sides were not all measured: in each layer, surfaces that are connected
/// and together thin get the convex hull of their outline, as filled-in patches that face outward. Beams that are far
/// apart make an outline too wide: patches with more than `max_spacing_ratio` times the closest distance of beams on
/// the object are left out of it.
std::vector<Patch> close_thin_objects(const std::vector<Patch>& patches, const ScannedGround& ground,
                                      const ThinObjectSettings& settings);

}  // namespace patrol::importer
