#pragma once

#include "core/settings.h"

namespace patrol::slam {

/// Matching of a scan to a map: coarse search, then least squares on the points.
struct ScanMatcherSettings {
  int max_points = 800;                 ///< maximum number of scan points that are matched
  double point_spacing_m = 0.08;        ///< distance of consecutive beam ends below which they are averaged
  double point_std_m = 0.015;           ///< standard deviation of the range of a point
  double point_angle_std_rad = 0.0005;  ///< standard deviation of the direction of a point
  double kernel_m = 0.05;           ///< scale of the Cauchy kernel; residuals beyond it are down-weighted as outliers
  int surface_radius_cells = 3;     ///< neighborhood of the line fit; also the largest initial distance of a point
  int max_iterations = 8;           ///< maximum number of iterations of fine matching
  double min_inlier_ratio = 0.3;    ///< minimum inlier ratio of an accepted match
  double search_window_m = 0.3;     ///< half width of the coarse search along x and y
  double search_window_rad = 0.12;  ///< half width of the coarse search in yaw
  int search_points = 200;          ///< number of scan points of the coarse search

  template <typename Self, typename Visitor>
  static void fields(Self& self, Visitor& visit) {
    visit("max_points", self.max_points, between(3, 100000));
    visit("point_spacing_m", self.point_spacing_m, between(0.0, 5.0));
    visit("point_std_m", self.point_std_m, between(1e-4, 1.0));
    visit("point_angle_std_rad", self.point_angle_std_rad, between(0.0, 0.1));
    visit("kernel_m", self.kernel_m, between(1e-3, 10.0));
    visit("surface_radius_cells", self.surface_radius_cells, between(1, 10));
    visit("max_iterations", self.max_iterations, between(1, 100));
    visit("min_inlier_ratio", self.min_inlier_ratio, between(0.0, 1.0));
    visit("search_window_m", self.search_window_m, between(0.0, 5.0));
    visit("search_window_rad", self.search_window_rad, between(0.0, 1.6));
    visit("search_points", self.search_points, between(3, 10000));
  }
};

}  // namespace patrol::slam
