#pragma once

#include <Eigen/Core>

#include "core/grid.h"
#include "core/settings.h"
#include "plan/perception/costmap.h"

namespace patrol::plan {

struct PotentialFieldSettings {
  double attraction = 1.0;            ///< force per cell of distance to the goal
  double repulsion = 0.5;             ///< against it
  double obstacle_range_cells = 2.5;  ///< a lethal cell's force ends at this distance, centre to centre

  template <typename Self, typename Visitor>
  static void fields(Self& self, Visitor& visit) {
    visit("attraction", self.attraction, between(0.0, 100.0));
    visit("repulsion", self.repulsion, between(0.0, 100.0));
    visit("obstacle_range_cells", self.obstacle_range_cells, between(1.0, 20.0));
  }
};

/// Resultant force on a robot at each cell's centre, as a share of the goal's attraction there: zero in lethal cells and at the goal.
///
/// Attraction grows with the distance to the goal. The nearest lethal cell repels with the two forces of Ge and Cui ("New potential functions for mobile
/// robot path planning", 2000, eqs. 8-11 with n = 1): one away from it, one towards the goal. Paper 003 names f_1, f_2 and f_a and gives no formula.
Grid<Eigen::Vector2d> potential_forces(const PotentialFieldSettings& settings, const Grid<Cost>& costs, Cell goal);

}  // namespace patrol::plan
