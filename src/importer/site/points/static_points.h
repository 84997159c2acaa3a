#pragma once

#include <functional>
#include <vector>

#include "importer/site/points/panorama.h"

namespace patrol::importer {

/// Numbers of points by their state.
struct StaticPointCounts {
  std::size_t num_points = 0;    ///< pixels with a return
  std::size_t num_outliers = 0;  ///< lone returns between surfaces
  std::size_t num_moving = 0;    ///< returns of moving objects
};

/// Finds outliers, moving objects and surfaces that several scans measured, and sets the states of the pixels.
///
/// - Outlier: a pixel whose range continues to none of its eight neighbors, as that of a beam on two surfaces.
/// - Moving: another scan looks through the point (its beams around the point return from farther away, or return
///   nothing although the surface would return them), and no scan observes it. A scan decides only if its beams are
///   closer together than the surface is wide, so that thin posts stay. Neighbors within 0.5 m that no scan observes
///   follow. An object that at least two scans observe at one position stays.
/// - Gaps without returns at a surface closer than the minimum range (near_gaps.h) are no evidence.
/// - Covered: another scan measured the surface with beams that are closer together on it.
/// `on_scan` is called before each scan is compared with the others, with its index.
StaticPointCounts find_static_points(std::vector<Panorama>& scans, const std::function<void(std::size_t)>& on_scan);

}  // namespace patrol::importer
