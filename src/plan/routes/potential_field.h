#pragma once

#include <Eigen/Core>

#include "core/grid.h"
#include "core/settings.h"
#include "plan/perception/costmap.h"

namespace patrol::plan {

struct PotentialFieldSettings {
  double attraction = 1.0;            ///< attractive force per cell of distance to the goal
  double repulsion = 0.5;             ///< weight of the repulsive force
  double obstacle_range_cells = 2.5;  ///< range of a lethal cell's force, center to center

  template <typename Self, typename Visitor>
  static void fields(Self& self, Visitor& visit) {
    visit("attraction", self.attraction, between(0.0, 100.0));
    visit("repulsion", self.repulsion, between(0.0, 100.0));
    visit("obstacle_range_cells", self.obstacle_range_cells, between(1.0, 20.0));
  }
};

/// Resultant force on a robot at each cell's center, relative to the goal's attraction there; zero in lethal cells and
/// at the goal.
///
/// Attraction grows with the distance to the goal. The nearest lethal cell repels with the two forces of [Ge00, eqs.
/// 8-11 with n = 1]: one away from it, one toward the goal. [Li22] names f_1, f_2 and f_a without a formula.
Grid<Eigen::Vector2d> potential_forces(const PotentialFieldSettings& settings, const Grid<Cost>& costs, Cell goal);

}  // namespace patrol::plan
