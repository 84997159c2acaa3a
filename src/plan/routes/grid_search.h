#pragma once

#include <cstdint>
#include <vector>

#include "plan/routes/route_planner.h"

namespace patrol::plan {

/// A* (Hart, Nilsson, Raphael 1968) with the octile distance, or without it Dijkstra's algorithm (1959): the cheapest of all routes over eight
/// neighbours. Prices are integers of 2^-32 cells: a route of 10^4 diagonal steps is priced to 10^-6 cells, and routes of equal price tie
/// exactly; of these the cell nearer to the goal is looked at first.
///
/// Holds its work space between calls: 16 bytes for each cell of the largest grid so far.
class GridSearch : public RoutePlanner {
 public:
  enum class Method { kAstar, kDijkstra };
  explicit GridSearch(Method method, double cost_weight = 0.0);

  bool is_complete() const override { return true; }

 private:
  using Price = std::uint64_t;
  struct Node {
    Price price;              ///< from the start
    std::uint32_t search;     ///< by which this node was last touched
    std::uint8_t came_by;     ///< index of the step that led here
    bool is_closed;
  };
  struct Open {
    Price estimate;           ///< of the whole route
    std::uint32_t remaining;  ///< of it still to go, in 2^-8 cells; breaks ties
    std::uint32_t index;
    /// For a heap with the best on top.
    bool operator<(const Open& other) const {
      return estimate != other.estimate ? estimate > other.estimate : remaining > other.remaining;
    }
  };

  void search(const Grid<Cost>& costs, Cell start, Cell goal, Route& route) override;
  void expand(const Grid<Cost>& costs, std::uint32_t index, Cell goal);
  void push(Price price, Cell cell, Cell goal, std::uint32_t index);
  std::vector<Eigen::Vector2d> trace_back(std::uint32_t width, Cell start, Cell goal) const;

  Method method_;
  std::array<Price, 256> half_straight_;  ///< [cost] price of half a step through such a cell
  std::array<Price, 256> half_diagonal_;
  std::vector<Node> nodes_;
  std::uint32_t num_searches_ = 0;
  std::vector<Open> open_;  ///< binary heap
};

}  // namespace patrol::plan
