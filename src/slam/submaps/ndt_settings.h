#pragma once

#include <vector>

#include "core/settings.h"

namespace patrol::slam {

struct NdtSettings {
  std::vector<double> cells_m = {8.0, 4.0, 2.0, 1.0, 0.5};  ///< cell sizes of the levels, coarse to fine
  /// Minimum standard deviation of a cell's normal, relative to the cell size; determines the capture range of a wall.
  double min_std_per_cell = 0.15;
  int max_points = 800;     ///< maximum number of source points; a regular subset of more points is used
  int max_iterations = 60;  ///< maximum number of iterations per level
  /// Displacement by a step at 10 m from the origin, relative to the cell size, below which a level has converged.
  double step_tolerance_per_cell = 5e-4;

  template <typename Self, typename Visitor>
  static void fields(Self& self, Visitor& visit) {
    visit("cells_m", self.cells_m, between(0.05, 100.0));
    visit("min_std_per_cell", self.min_std_per_cell, between(0.001, 1.0));
    visit("max_points", self.max_points, between(3, 1000000));
    visit("max_iterations", self.max_iterations, between(1, 10000));
    visit("step_tolerance_per_cell", self.step_tolerance_per_cell, between(1e-9, 0.1));
  }
};

}  // namespace patrol::slam
