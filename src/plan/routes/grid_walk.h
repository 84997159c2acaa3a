#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "plan/routes/route_planner.h"

namespace patrol::plan {

/// A grid's cells in a row, and which steps lead out of each.
struct StepGraph {
  StepGraph(const Grid<Cost>& costs, const std::array<double, 256>& factors);

  std::uint32_t index_of(Cell cell) const { return static_cast<std::uint32_t>(cell.row * width + cell.col); }
  Cell cell_of(std::uint32_t index) const { return {static_cast<int>(index) % width, static_cast<int>(index) / width}; }
  std::uint32_t next(std::uint32_t cell, std::size_t direction) const {
    return static_cast<std::uint32_t>(static_cast<int>(cell) + offsets[direction]);
  }
  bool has_step(std::uint32_t cell, std::size_t direction) const { return (steps[cell] >> direction & 1u) != 0; }
  /// Of a step, cells.
  double price(std::uint32_t cell, std::size_t direction) const;

  int width;
  std::array<int, 8> offsets;        ///< [direction] of kGridSteps, in the row of cells
  std::vector<std::uint8_t> steps;   ///< [cell] bit by direction
  std::vector<double> cell_factors;  ///< [cell]
};

/// A way through the graph: [i] leaves `cells[i]` by `directions[i]`; the goal is not among the cells.
struct Walk {
  std::vector<std::uint32_t> cells;
  std::vector<std::uint8_t> directions;
  double cost = 0.0;           ///< cells
  std::int64_t num_steps = 0;  ///< taken, with those back
};

/// Centres of its cells.
std::vector<Eigen::Vector2d> points_of(const StepGraph& graph, const Walk& walk, Cell goal);

/// Walks from cell to cell without entering one twice, back out of dead ends; holds its work space.
class Walker {
 public:
  explicit Walker(const StepGraph& graph);

  /// `choose(cell, open)` picks one of the directions whose bits are set in `open`: those into cells not yet visited. Where there is none, the walk goes back.
  /// Returns no cells if it comes back to the start so: it has been everywhere, and there is no way. The cost is left at 0.
  template <typename Choose>
  Walk walk(std::uint32_t start, std::uint32_t goal, Choose choose) {
    ++num_walks_;
    visit_[start] = num_walks_;
    Walk walk;
    for (std::uint32_t here = start; here != goal; ++walk.num_steps) {
      unsigned open = graph_.steps[here];
      for (std::size_t direction = 0; direction < 8; ++direction) {
        if ((open >> direction & 1u) != 0 && visit_[graph_.next(here, direction)] == num_walks_) open &= ~(1u << direction);
      }
      if (open == 0) {
        if (walk.cells.empty()) return walk;
        here = walk.cells.back();
        walk.cells.pop_back();
        walk.directions.pop_back();
        continue;
      }
      const std::size_t direction = choose(here, open);
      walk.cells.push_back(here);
      walk.directions.push_back(static_cast<std::uint8_t>(direction));
      here = graph_.next(here, direction);
      visit_[here] = num_walks_;
    }
    return walk;
  }

  /// From each cell on, the step to the latest of the walk's cells beside it replaces what lies between. The walk may cross itself before, not after.
  void splice(Walk& walk, std::uint32_t goal);

  /// Pulls a walk that enters no cell twice tight: stretches that cost more than a shortest way over open ground between their ends (diagonal steps and straight
  /// ones, evenly mixed, or the ones before the others) are replaced by that. What is left depends on which way round obstacles the walk went.
  void tighten(Walk& walk, std::uint32_t goal);

 private:
  const StepGraph& graph_;
  std::vector<std::uint32_t> visit_;     ///< [cell] the walk that was here last
  std::vector<std::uint32_t> position_;  ///< [cell] in the walk, its last place
  std::uint32_t num_walks_ = 0;
};

/// Sum of its steps' prices.
double cost_of(const StepGraph& graph, const Walk& walk);

}  // namespace patrol::plan
