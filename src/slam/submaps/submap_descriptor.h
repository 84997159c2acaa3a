#pragma once

#include <Eigen/Core>

#include <cstddef>
#include <vector>

#include "core/geometry/convex_polygon.h"
#include "core/settings.h"
#include "slam/grid_map.h"
#include "slam/submaps/ndt.h"
#include "slam/submaps/observed_cells.h"

namespace patrol::slam {

struct SubmapDescriptorSettings {
  int max_points = 300;            ///< maximum number of compared points; a regular subset of larger submaps is used
  double normal_radius_m = 0.4;    ///< radius of the neighborhood whose principal axis is the direction of the wall
  double distance_bin_m = 1.0;     ///< bin width of the histogram of distances between points
  int distance_bins = 40;          ///< number of distance bins; the last one includes all larger distances
  int direction_bins = 36;         ///< number of direction bins over half a turn
  double observed_cell_m = 0.25;
  NdtSettings ndt;

  template <typename Self, typename Visitor>
  static void fields(Self& self, Visitor& visit) {
    visit("max_points", self.max_points, between(3, 100000));
    visit("normal_radius_m", self.normal_radius_m, between(0.01, 10.0));
    visit("distance_bin_m", self.distance_bin_m, between(0.01, 100.0));
    visit("distance_bins", self.distance_bins, between(2, 10000));
    visit("direction_bins", self.direction_bins, between(4, 720));
    visit("observed_cell_m", self.observed_cell_m, between(0.05, 10.0));
    visit("ndt", self.ndt);
  }
};

/// Descriptor of a submap for comparison with others, computed once. All coordinates are in submap.
struct SubmapDescriptor {
  std::vector<Eigen::Vector2d> points;  ///< downsampled surface points
  std::size_t num_points = 0;           ///< before downsampling
  Eigen::Vector2d center = Eigen::Vector2d::Zero();  ///< mean of the points
  double radius_m = 0.0;                ///< root mean square distance of the points from the center
  ConvexPolygon hull;                   ///< convex hull of the points
  std::vector<double> distances;        ///< [bin], fractions of all pairs of points: shape distribution D2 [Osada02]
  /// [bin] over half a turn from x on, fractions of the wall directions; points off straight walls have small weights
  std::vector<double> directions;
  ObservedCells observed;
  std::vector<NdtGrid> ndt;
};

/// Computes the descriptor of a submap. `points_submap` must be at least three finite points; throws InputError
/// otherwise.
SubmapDescriptor describe_submap(const std::vector<Eigen::Vector2d>& points_submap, const GridMap& map, const SubmapDescriptorSettings& settings);

/// Difference of two histograms with equal numbers of bins, each of sum 1: 0 equal ... 1 disjoint.
double histogram_difference(const std::vector<double>& a, const std::vector<double>& b);

/// Pearson correlation of a with b rotated cyclically by `shift` bins: -1 ... 1; 0 if either histogram is uniform. Bin
/// 0 of b is aligned with bin `shift` of a.
double circular_correlation(const std::vector<double>& a, const std::vector<double>& b, int shift);

}  // namespace patrol::slam
