#pragma once

#include "core/settings.h"

namespace patrol::slam {

struct PoseGraphSolverSettings {
  int max_iterations = 50;           ///< maximum number of iterations of the optimization
  bool robust_loop_closures = true;  ///< use of a robust loss on edges that are not odometry
  /// Scale of the Cauchy kernel, in standard deviations; used for loop closures if robust_loop_closures, and always for
  /// ranges.
  double loop_closure_loss_scale = 3.0;

  template <typename Self, typename Visitor>
  static void fields(Self& self, Visitor& visit) {
    visit("max_iterations", self.max_iterations, between(1, 1000));
    visit("robust_loop_closures", self.robust_loop_closures);
    visit("loop_closure_loss_scale", self.loop_closure_loss_scale, at_least(0.1));
  }
};

}  // namespace patrol::slam
