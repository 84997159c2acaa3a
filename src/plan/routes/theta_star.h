#pragma once

#include <cstdint>
#include <vector>

#include "plan/routes/route_planner.h"

namespace patrol::plan {

/// Theta* (Nash, Daniel, Koenig, Felner, "Theta*: any-angle path planning on grids", AAAI 2007): A* whose cells may take any cell in sight as their parent, the
/// straight line to it costing no more than the way through the neighbour. Turns only at cells' centres; a line of sight meets no lethal cell, not
/// even at a corner. Never dearer than A*'s route, since no cell is reached dearer than by its neighbours; not always the cheapest there is.
///
/// Holds its work space between calls.
class ThetaStar : public RoutePlanner {
 public:
  explicit ThetaStar(double cost_weight = 0.0) : RoutePlanner(cost_weight) {}

  bool is_complete() const override { return true; }

 private:
  struct Node {
    double price;          ///< from the start, cells
    Cell parent;
    std::uint32_t search;  ///< by which this node was last touched
    bool is_closed;
  };
  struct Open {
    double estimate, price;  ///< of the whole route; so far
    Cell cell;
    /// For a heap with the best on top; of equal estimates the one farther on.
    bool operator<(const Open& other) const { return estimate != other.estimate ? estimate > other.estimate : price < other.price; }
  };

  void search(const Grid<Cost>& costs, Cell start, Cell goal, Route& route) override;
  void expand(const Grid<Cost>& costs, Cell cell, Cell goal);

  Grid<Node> nodes_;
  std::uint32_t num_searches_ = 0;
  std::vector<Open> open_;  ///< binary heap
};

}  // namespace patrol::plan
