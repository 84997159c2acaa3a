#pragma once

#include "core/settings.h"

namespace patrol::localize {

/// Settings of the refinement of the pose by matching a scan to the map (pose_refinement.h).
struct PoseRefinementSettings {
  int max_points = 400;  ///< maximum number of scan points matched to the map
  /// Maximum distance between the first and last of the consecutive beam ends averaged to one scan point.
  double point_spacing_m = 0.1;
  /// Standard deviation of the distance of a scan point from its line: range noise and map cells.
  double point_std_m = 0.03;
  double point_angle_std_rad = 0.0015;  ///< standard deviation of the direction of a scan point from the lidar
  /// Scale of the Cauchy kernel of the point-to-line distances; residuals beyond it are down-weighted as outliers.
  /// Points within twice the scale are inliers.
  double kernel_m = 0.08;
  /// Tempering factor of the information of a scan: fraction of the points with independent errors.
  double likelihood_tempering = 0.1;
  /// Minimum sine of the angle to the weak direction of a scan for a map line that constrains this direction (solution
  /// remapping [Zhang16]).
  double min_incidence_sine = 0.15;
  /// Standard deviation of the position error that the map causes, which is not reduced by averaging.
  double map_std_m = 0.01;
  /// Standard deviation of the yaw error that the map causes, which is not reduced by averaging.
  double map_std_rad = 0.001;
  int max_iterations = 8;         ///< maximum number of iterations of the pose refinement
  double min_inlier_ratio = 0.3;  ///< minimum inlier ratio of an accepted scan match

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
