#pragma once

#include "core/settings.h"

namespace patrol::localize {

struct PoseRefinementSettings {
  int max_points = 400;                 ///< maximum number of scan points matched to the map
  double point_spacing_m = 0.1;         ///< distance of consecutive beam ends below which they are averaged
  double point_std_m = 0.03;            ///< standard deviation of the range of a point and of the map cells
  double point_angle_std_rad = 0.0015;  ///< standard deviation of the direction of a point
  double kernel_m = 0.08;             ///< scale of the Cauchy kernel; residuals beyond it are down-weighted as outliers
  double likelihood_tempering = 0.1;  ///< tempering factor: fraction of the points with independent errors
  /// Minimum sine of the angle between a line and the weak direction that the line constrains.
  double min_incidence_sine = 0.15;
  double map_std_m = 0.01;        ///< standard deviation of the map itself, which is not reduced by averaging
  double map_std_rad = 0.001;     ///< standard deviation of the yaw error that the map causes
  int max_iterations = 8;         ///< maximum number of iterations of the refinement
  double min_inlier_ratio = 0.3;  ///< minimum inlier ratio of an accepted match

  template <typename Self, typename Visitor>
  static void fields(Self& self, Visitor& visit) {
    visit("max_points", self.max_points, between(10, 100000));
    visit("point_spacing_m", self.point_spacing_m, between(0.0, 5.0));
    visit("point_std_m", self.point_std_m, between(1e-4, 1.0));
    visit("point_angle_std_rad", self.point_angle_std_rad, between(0.0, 0.1));
    visit("kernel_m", self.kernel_m, between(1e-3, 10.0));
    visit("likelihood_tempering", self.likelihood_tempering, between(1e-4, 1.0));
    visit("min_incidence_sine", self.min_incidence_sine, between(0.0, 0.9));
    visit("map_std_m", self.map_std_m, between(0.0, 1.0));
    visit("map_std_rad", self.map_std_rad, between(0.0, 0.1));
    visit("max_iterations", self.max_iterations, between(1, 100));
    visit("min_inlier_ratio", self.min_inlier_ratio, between(0.0, 1.0));
  }
};

}  // namespace patrol::localize
