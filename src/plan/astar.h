#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "core/grid.h"
#include "core/settings.h"
#include "plan/costmap.h"

namespace patrol::plan {

struct AstarSettings {
  double cost_weight = 4.0;        ///< a metre at the highest passable cost counts as 1 + this many metres
  double goal_tolerance_m = 0.3;   ///< a blocked goal may be replaced by a free place this near
  double start_tolerance_m = 0.6;  ///< likewise the start: the robot stands there, so it must get out

  template <typename Self, typename Visitor>
  static void fields(Self& self, Visitor& visit) {
    visit("cost_weight", self.cost_weight, between(0.0, 50.0));
    visit("goal_tolerance_m", self.goal_tolerance_m, between(0.0, 5.0));
    visit("start_tolerance_m", self.start_tolerance_m, between(0.0, 5.0));
  }
};

enum class PlanStatus { kFound, kStartBlocked, kGoalBlocked, kNoRoute };

struct PlanResult {
  PlanStatus status = PlanStatus::kNoRoute;
  std::vector<Eigen::Vector2d> points_m;  ///< in map, from start to goal, cell by cell
  double length_m = 0.0;
  double cost_m = 0.0;                    ///< length, each metre weighted by its cells' costs
  bool is_goal_moved = false;             ///< the goal was blocked; the route ends at the nearest free place
  int num_expanded = 0;
};

/// A* (Hart, Nilsson, Raphael 1968) on the costmap's cells with eight neighbours. The octile distance never
/// overestimates, since a cell counts its length at least, so the route is the cheapest there is. Diagonal steps do not cut the
/// corner of a lethal cell. Costs are integers: the same grid gives the same route everywhere.
///
/// Holds its work space between calls; flat arrays as large as the grid.
class AstarPlanner {
 public:
  explicit AstarPlanner(const AstarSettings& settings);

  PlanResult plan(const Grid<Cost>& costs, const Eigen::Vector2d& p_map_start, const Eigen::Vector2d& p_map_goal);

 private:
  struct Node {
    std::uint32_t cost;        ///< from the start
    std::uint32_t search;      ///< the search this node was last touched by
    std::uint8_t came_by;      ///< direction of the step that led here
    bool is_closed;
  };

  bool search(const Grid<Cost>& costs, Cell start, Cell goal, PlanResult& result);
  void expand(const Grid<Cost>& costs, Cell cell, Cell goal);
  std::vector<Cell> trace_back(const GridGeometry& geometry, Cell start, Cell goal) const;

  AstarSettings settings_;
  std::uint32_t straight_[256];  ///< price of a step into a cell of this cost
  std::uint32_t diagonal_[256];
  std::vector<Node> nodes_;
  std::uint32_t num_searches_ = 0;
  std::vector<std::uint64_t> open_;  ///< binary heap of (estimate << 32 | index), smallest first
};

/// The cell nearest to `p` that is not lethal, within `radius_m`; none if all are lethal. A point in a passable cell
/// is its own nearest.
std::optional<Cell> nearest_passable(const Grid<Cost>& costs, const Eigen::Vector2d& p, double radius_m);

}  // namespace patrol::plan
