#pragma once

#include <cstdint>
#include <vector>

#include "plan/routes/route_planner.h"

namespace patrol::plan {

/// Planner of the shortest path in the plane: straight lines between the centers of the end cells and corners of lethal
/// cells. Its length is a lower bound for all planners. The path touches the cells that it goes around, as a bound
/// must; it never passes between two cells that meet at a corner. Routes of the other planners keep off corners, and
/// are longer by that too.
///
/// Method: A* over the visibility graph, whose edges are found only for the corners that it expands. A cone of visible
/// directions spreads from the corner over the cells, and each corner in it is checked exactly, in integers.
///
/// For reference only: on open ground the time grows with the number of corners times the number of cells visible from
/// each. Supports no costs but lethal.
class VisibilityGraphPlanner : public RoutePlanner {
 public:
  VisibilityGraphPlanner() : RoutePlanner(0.0) {}

  bool is_complete() const override { return true; }

 private:
  void search(const Grid<Cost>& costs, Cell start, Cell goal, Route& route) override;
};

/// Point in half cells from the grid's lower-left corner. Corners of cells have even coordinates, centers odd ones.
struct HalfCellPoint {
  int x = 0, y = 0;
  friend bool operator==(const HalfCellPoint&, const HalfCellPoint&) = default;
};

/// Whether the straight line between two corners or centers passes neither through the inside of a lethal cell nor
/// between two that meet at a corner or a side. It may touch lethal cells. Both points are in the grid.
bool is_visible(const Grid<Cost>& costs, HalfCellPoint from, HalfCellPoint to);

}  // namespace patrol::plan
