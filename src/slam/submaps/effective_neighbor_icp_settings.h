#pragma once

#include "core/settings.h"

namespace patrol::slam {

struct IcpSettings {
  bool use_effective_neighbors = true;  ///< use of effective neighbors only; false: all pairs, as in ICP [Besl92]
  /// Lower bound of the threshold: below about one point spacing, distances reflect the point pattern.
  double min_threshold_m = 0.1;
  double max_threshold_m = 0.3;  ///< upper bound of the threshold: coarse matching leaves smaller errors
  bool point_to_line = true;     ///< use of point-to-line distances after the convergence with point-to-point distances
  double line_threshold_m = 0.1;  ///< upper bound of the threshold in point-to-line steps
  double line_kernel_m = 0.04;    ///< distance at which a pair has half weight in point-to-line steps
  int max_iterations = 100;       ///< maximum number of iterations
  /// Displacement by a step, at 10 m from the origin, below which the iteration has converged.
  double step_tolerance_m = 1e-5;
  int min_pairs = 10;            ///< minimum number of pairs of an accepted match
  double point_std_m = 0.03;     ///< standard deviation of a point across its wall, for the information
  double normal_radius_m = 0.3;  ///< radius of the neighborhood whose principal axis gives the normal

  template <typename Self, typename Visitor>
  static void fields(Self& self, Visitor& visit) {
    visit("use_effective_neighbors", self.use_effective_neighbors);
    visit("min_threshold_m", self.min_threshold_m, at_least(0.0));
    visit("max_threshold_m", self.max_threshold_m, at_least(0.0));
    visit("point_to_line", self.point_to_line);
    visit("line_threshold_m", self.line_threshold_m, between(1e-3, 10.0));
    visit("line_kernel_m", self.line_kernel_m, between(1e-3, 10.0));
    visit("max_iterations", self.max_iterations, between(1, 100000));
    visit("step_tolerance_m", self.step_tolerance_m, between(0.0, 1.0));
    visit("min_pairs", self.min_pairs, between(2, 100000));
    visit("point_std_m", self.point_std_m, between(1e-4, 10.0));
    visit("normal_radius_m", self.normal_radius_m, between(1e-3, 10.0));
  }
};

}  // namespace patrol::slam
