#pragma once

#include <Eigen/Core>

#include <cstddef>
#include <vector>

#include "core/convex_polygon.h"
#include "core/settings.h"
#include "slam/grid_map.h"
#include "slam/submaps/ndt.h"
#include "slam/submaps/seen_cells.h"

namespace patrol::slam {

struct SubmapShapeSettings {
  int max_points = 300;            ///< of a submap that are compared; if it has more, every so many
  double normal_radius_m = 0.4;    ///< neighbourhood whose principal axis is a wall's direction
  double distance_bin_m = 1.0;     ///< of the histogram of distances between points
  int distance_bins = 40;          ///< the last holds all that is farther
  int direction_bins = 36;         ///< of half a turn
  double seen_cell_m = 0.25;
  NdtSettings ndt;

  template <typename Self, typename Visitor>
  static void fields(Self& self, Visitor& visit) {
    visit("max_points", self.max_points, between(3, 100000));
    visit("normal_radius_m", self.normal_radius_m, between(0.01, 10.0));
    visit("distance_bin_m", self.distance_bin_m, between(0.01, 100.0));
    visit("distance_bins", self.distance_bins, between(2, 10000));
    visit("direction_bins", self.direction_bins, between(4, 720));
    visit("seen_cell_m", self.seen_cell_m, between(0.05, 10.0));
    visit("ndt", self.ndt);
  }
};

/// What is kept of a submap to compare it with others: made once. All in submap.
struct SubmapShape {
  std::vector<Eigen::Vector2d> points;  ///< of its surfaces, thinned
  std::size_t num_points = 0;           ///< before
  Eigen::Vector2d center = Eigen::Vector2d::Zero();  ///< mean of the points
  double radius_m = 0.0;                ///< root mean square distance of the points from the centre
  ConvexPolygon hull;                   ///< of the points
  std::vector<double> distances;        ///< [bin], shares of all pairs of points (the shape distribution D2 of Osada et al., ACM Trans. Graphics 2002)
  std::vector<double> directions;       ///< [bin] of half a turn from x on, shares of the walls' directions; points that lie on no wall count little
  SeenCells seen;
  std::vector<NdtGrid> ndt;
};

/// `points_submap`: at least three, finite. Throws InputError otherwise.
SubmapShape describe_submap(const std::vector<Eigen::Vector2d>& points_submap, const GridMap& map, const SubmapShapeSettings& settings);

/// Shares that lie in different bins: 0 alike ... 1 nothing in common. Histograms of the same number of bins, each of sum 1.
double histogram_difference(const std::vector<double>& a, const std::vector<double>& b);

/// Pearson's correlation of a with b turned on by `shift` bins (b's bin 0 lies on a's bin `shift`), around the circle: -1 ... 1; 0 if either is even.
double circular_correlation(const std::vector<double>& a, const std::vector<double>& b, int shift);

}  // namespace patrol::slam
