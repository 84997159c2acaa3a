#pragma once

#include <cstdint>
#include <vector>

#include "plan/routes/route_planner.h"

namespace patrol::plan {

/// Theta* [Nash07]: A* in which a cell may take any visible cell as its parent, if the straight line to it costs no
/// more than the path through the neighbor. Paths turn only at cell centers. A line of sight touches no lethal cell,
/// not even at a corner. A path never costs more than that of A*, because no cell is reached at a higher cost than
/// through its neighbors; it is not always optimal.
///
/// Keeps its work space between calls.
class ThetaStar : public RoutePlanner {
 public:
  explicit ThetaStar(double cost_weight = 0.0) : RoutePlanner(cost_weight) {}

  bool is_complete() const override { return true; }

 private:
  struct Node {
    double cost;  ///< cost from the start, cells
    Cell parent;
    std::uint32_t search;  ///< number of the search that last updated this node
    bool is_closed;
  };
  struct Open {
    double estimate, cost;  ///< estimated cost of the whole route; cost from the start to this node
    Cell cell;
    /// Order for a heap with the best node on top; of equal estimates, the one with the higher cost from the start.
    bool operator<(const Open& other) const {
      return estimate != other.estimate ? estimate > other.estimate : cost < other.cost;
    }
  };

  void search(const Grid<Cost>& costs, Cell start, Cell goal, Route& route) override;
  void expand(const Grid<Cost>& costs, Cell cell, Cell goal);

  Grid<Node> nodes_;
  std::uint32_t num_searches_ = 0;
  std::vector<Open> open_;  ///< binary heap
};

}  // namespace patrol::plan
