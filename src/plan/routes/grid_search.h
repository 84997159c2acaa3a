#pragma once

#include <cstdint>
#include <vector>

#include "plan/routes/route_planner.h"

namespace patrol::plan {

/// A* [Hart68] with the octile distance, or Dijkstra's algorithm [Dijkstra59]: the route of minimum cost over eight
/// neighbors. Costs are integers in units of 2^-32 cells: a route of 10^4 diagonal steps is accurate to 10^-6 cells,
/// and routes of equal cost tie exactly. Ties are broken in favor of the cell nearer to the goal.
///
/// Keeps its work space between calls: 16 bytes per cell of the largest grid so far.
class GridSearch : public RoutePlanner {
 public:
  enum class Method { kAstar, kDijkstra };
  explicit GridSearch(Method method, double cost_weight = 0.0);

  bool is_complete() const override { return true; }

 private:
  using PathCost = std::uint64_t;
  struct Node {
    PathCost path_cost;    ///< cost from the start
    std::uint32_t search;  ///< number of the search that last updated this node
    std::uint8_t came_by;  ///< index of the step to this node from its parent
    bool is_closed;
  };
  struct Open {
    PathCost estimate;        ///< estimated cost of the whole route
    std::uint32_t remaining;  ///< estimated cost to the goal, in 2^-8 cells; breaks ties
    std::uint32_t index;
    /// Order for a heap with the best node on top.
    bool operator<(const Open& other) const {
      return estimate != other.estimate ? estimate > other.estimate : remaining > other.remaining;
    }
  };

  void search(const Grid<Cost>& costs, Cell start, Cell goal, Route& route) override;
  void expand(const Grid<Cost>& costs, std::uint32_t index, Cell goal);
  void push(PathCost path_cost, Cell cell, Cell goal, std::uint32_t index);
  std::vector<Eigen::Vector2d> trace_back(std::uint32_t width, Cell start, Cell goal) const;

  Method method_;
  std::array<PathCost, 256> half_straight_{};  ///< [cost] cost of half a step through such a cell
  std::array<PathCost, 256> half_diagonal_{};
  std::vector<Node> nodes_;
  std::uint32_t num_searches_ = 0;
  std::vector<Open> open_;  ///< binary heap
};

}  // namespace patrol::plan
