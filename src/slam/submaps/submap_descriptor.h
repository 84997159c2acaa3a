#pragma once

#include <cstddef>
#include <vector>

#include <Eigen/Core>

#include "core/geometry/convex_polygon.h"
#include "slam/grid_map.h"
#include "slam/submaps/ndt.h"
#include "slam/submaps/observed_cells.h"
#include "slam/submaps/submap_descriptor_settings.h"

namespace patrol::slam {

/// Descriptor of a submap for comparison with others, computed once. All coordinates are in submap.
struct SubmapDescriptor {
  std::vector<Eigen::Vector2d> points;               ///< downsampled surface points
  std::size_t num_points = 0;                        ///< number of surface points before downsampling
  Eigen::Vector2d center = Eigen::Vector2d::Zero();  ///< mean of the points
  double radius_m = 0.0;                             ///< root mean square distance of the points from the center
  ConvexPolygon hull;                                ///< convex hull of the points
  std::vector<double> distances;  ///< [bin], fractions of all pairs of points: shape distribution D2 [Osada02]
  /// [bin] over half a turn from x on, fractions of the wall directions; points off straight walls have small weights
  std::vector<double> directions;
  ObservedCells observed;
  std::vector<NdtGrid> ndt;
};

/// Computes the descriptor of a submap. `points_submap` must be at least three finite points; throws InputError
/// otherwise.
SubmapDescriptor describe_submap(const std::vector<Eigen::Vector2d>& points_submap, const GridMap& map,
                                 const SubmapDescriptorSettings& settings);

/// Difference of two histograms with equal numbers of bins, each of sum 1: 0 equal ... 1 disjoint.
double histogram_difference(const std::vector<double>& a, const std::vector<double>& b);

/// Pearson correlation of a with b rotated cyclically by `shift` bins: -1 ... 1; 0 if either histogram is uniform. Bin
/// 0 of b is aligned with bin `shift` of a.
double circular_correlation(const std::vector<double>& a, const std::vector<double>& b, int shift);

}  // namespace patrol::slam
