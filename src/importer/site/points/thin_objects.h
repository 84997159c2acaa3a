#pragma once

#include <vector>

#include "importer/site/points/panorama.h"
#include "importer/site/points/patch.h"
#include "importer/site/points/scanned_ground.h"

namespace patrol::importer {

struct ThinObjectSettings {
  double layer_m = 0.4;               ///< height of the layers
  double min_layer_m = 0.05;          ///< layers of lattices are halved to at least this height
  double cell_m = 0.05;               ///< cells that connect surfaces within a layer
  double fine_cell_m = 0.025;         ///< cells that connect surfaces of a divided object
  double max_extent_m = 1.2;          ///< largest extent of an object along x and y
  double lowest_m = 0.02;             ///< lowest height above the ground
  double highest_m = 8.0;             ///< highest height above the ground
  double inset_m = 0.004;             ///< distance of the filled-in sides behind the measured ones
  float max_spacing_ratio = 4.0f;     ///< largest ratio of the distances of beams in an outline
  int max_beams = 120;                ///< beams of a scan that a fit uses
  double max_cost = 0.25;             ///< largest cost of a fitted outline
  double edge_m = 0.02;               ///< half width of the strip at the edges of a post in which beams are mixed
  double depth_m = 0.03;              ///< largest distance of a beam's return from the outline of its post
  double max_fit_disagreement = 0.1;  ///< largest fraction of beams that do not return from a fitted outline
  double max_disagreement = 0.2;      ///< largest fraction of beams that do not return from a convex hull
};

/// Returns the sides of posts and other thin objects, which the scans saw from some directions only, as patches that
/// face outward; filled in where no scan measured the side. In each layer, steep surfaces that are connected and
/// together thin are an object:
///
/// - A circle or a rectangle with a slope is fitted to the beams of the scans past and onto it (post_fit.h). If the
///   beams agree with it, it replaces the measured surfaces: their pixels become kPixelCovered.
/// - Otherwise the convex hull of its outline closes it, if the beams agree with that.
/// - Otherwise, as for a lattice, the object is divided at smaller gaps, then at half the height of the layer, until
///   its parts agree or are too low.
///
/// Beams that are far apart make an outline too wide: patches with more than `max_spacing_ratio` times the closest
/// distance of beams on the object are left out of it. Without scans, all objects get their convex hull.
std::vector<Patch> close_thin_objects(const std::vector<Patch>& patches, std::vector<Panorama>& scans,
                                      const ScannedGround& ground, const ThinObjectSettings& settings);

}  // namespace patrol::importer
