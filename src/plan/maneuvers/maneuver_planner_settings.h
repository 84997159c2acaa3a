#pragma once

#include "core/settings.h"

namespace patrol::plan {

/// Settings of the planner for robots that cannot turn in place.
struct ManeuverPlannerSettings {
  double radius_factor = 1.15;       ///< ratio of the planned to the robot's minimum turning radius: room for control
  double step_m = 0.5;               ///< length of an arc of the search
  double reverse_weight = 2.0;       ///< cost of a meter driven backward relative to a meter driven forward
  double direction_change_m = 2.0;   ///< cost of a change of direction, in meters
  double cost_weight = 4.0;          ///< cost of a meter at the highest passable cost of the costmap, in more meters
  double greediness = 1.5;           ///< weight of the estimated remaining cost; above 1, the search is faster and the
                                     ///< maneuver at most as many times as costly as the best
  int max_expanded_thousands = 100;  ///< maximum number of expanded states, in thousands

  template <typename Self, typename Visitor>
  static void fields(Self& self, Visitor& visit) {
    visit("radius_factor", self.radius_factor, between(1.0, 3.0));
    visit("step_m", self.step_m, between(0.1, 2.0));
    visit("reverse_weight", self.reverse_weight, between(1.0, 100.0));
    visit("direction_change_m", self.direction_change_m, between(0.0, 100.0));
    visit("cost_weight", self.cost_weight, between(0.0, 50.0));
    visit("greediness", self.greediness, between(1.0, 5.0));
    visit("max_expanded_thousands", self.max_expanded_thousands, between(1, 10000));
  }
};

}  // namespace patrol::plan
