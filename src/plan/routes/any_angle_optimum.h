#pragma once

#include <cstdint>
#include <vector>

#include "plan/routes/route_planner.h"

namespace patrol::plan {

/// The shortest of all ways over the plane, straight lines between the ends' centres and corners of lethal cells: the length that no planner's route can
/// undercut. It touches the cells that it goes round, as a bound must; it never passes between two that meet at a corner. (Routes of the other
/// planners stay off corners, and exceed it by that too.) A* over the visibility graph, whose edges are found only for the corners it expands: light
/// spreads from the corner over the cells, and each corner that it reaches is checked exactly, in integers.
///
/// A reference, not a planner to drive by: on open ground its time grows with the corners times the cells in sight of each. Knows no costs but lethal.
class AnyAngleOptimum : public RoutePlanner {
 public:
  AnyAngleOptimum() : RoutePlanner(0.0) {}

  bool is_complete() const override { return true; }

 private:
  void search(const Grid<Cost>& costs, Cell start, Cell goal, Route& route) override;
};

/// A point in half cells from the grid's lower-left corner: cells' corners have even coordinates, their centres odd ones.
struct HalfCellPoint {
  int x = 0, y = 0;
  friend bool operator==(const HalfCellPoint&, const HalfCellPoint&) = default;
};

/// Whether the straight line between two corners or centres passes through no lethal cell's inside, nor between two that meet at a corner or a side. It
/// may touch. Both points lie in the grid.
bool can_see(const Grid<Cost>& costs, HalfCellPoint from, HalfCellPoint to);

}  // namespace patrol::plan
