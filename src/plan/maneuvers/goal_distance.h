#pragma once

#include <Eigen/Core>

#include "core/grid.h"
#include "plan/perception/cost.h"

namespace patrol::plan {

/// Weighted distance to a goal over a costmap, for a point that moves in all directions: Dijkstra's algorithm on blocks
/// of cells. Each block has the lowest cost of its cells, so that it underestimates.
class GoalDistance {
 public:
  /// `cost_weight`: additional meters of a meter at the highest passable cost.
  GoalDistance(const Grid<Cost>& costs, const Eigen::Vector2d& p_map_goal, double cost_weight);

  /// Returns the distance at a position, m; infinity where there is no path.
  double at(const Eigen::Vector2d& p_map) const;
  int num_expanded() const { return num_expanded_; }

 private:
  Grid<float> distance_m_;
  int num_expanded_ = 0;
};

}  // namespace patrol::plan
