#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "plan/routes/route_planner.h"

namespace patrol::plan {

/// Cells of a grid in row-major order, with the valid steps out of each.
struct StepGraph {
  StepGraph(const Grid<Cost>& costs, const std::array<double, 256>& factors);

  std::uint32_t index_of(Cell cell) const { return static_cast<std::uint32_t>(cell.row * width + cell.col); }
  Cell cell_of(std::uint32_t index) const { return {static_cast<int>(index) % width, static_cast<int>(index) / width}; }
  std::uint32_t next(std::uint32_t cell, std::size_t direction) const {
    return static_cast<std::uint32_t>(static_cast<int>(cell) + offsets[direction]);
  }
  bool has_step(std::uint32_t cell, std::size_t direction) const { return (steps[cell] >> direction & 1u) != 0; }
  /// Cost of a step, cells.
  double step_cost(std::uint32_t cell, std::size_t direction) const;

  int width;
  std::array<int, 8> offsets{};      ///< [direction] of kGridSteps, index offset
  std::vector<std::uint8_t> steps;   ///< [cell], one bit per direction
  std::vector<double> cell_factors;  ///< [cell], cost factor
};

/// Path through the graph. Step i leaves `cells[i]` in `directions[i]`; the goal is not among the cells.
struct GridPath {
  std::vector<std::uint32_t> cells;
  std::vector<std::uint8_t> directions;
  double cost = 0.0;           ///< cells
  std::int64_t num_steps = 0;  ///< number of steps taken, including backtracking
};

/// Converts a path to the centers of its cells, in cells, goal included.
std::vector<Eigen::Vector2d> to_points(const StepGraph& graph, const GridPath& path, Cell goal);

/// Builds paths that enter no cell twice and backtrack out of dead ends; keeps its work space.
class GridPathBuilder {
 public:
  explicit GridPathBuilder(const StepGraph& graph);

  /// Builds a path from `start` to `goal`. `choose(cell, open)` picks one of the directions whose bits are set in
  /// `open`: those into cells not yet visited. Without one, the path backtracks. Returns no cells if it backtracks from
  /// the start: no route exists. The cost is left at 0.
  template <typename Choose>
  GridPath build(std::uint32_t start, std::uint32_t goal, Choose choose) {
    ++num_paths_;
    visit_[start] = num_paths_;
    GridPath path;
    for (std::uint32_t here = start; here != goal; ++path.num_steps) {
      unsigned open = graph_.steps[here];
      for (std::size_t direction = 0; direction < 8; ++direction) {
        if ((open >> direction & 1u) != 0 && visit_[graph_.next(here, direction)] == num_paths_)
          open &= ~(1u << direction);
      }
      if (open == 0) {
        if (path.cells.empty()) return path;
        here = path.cells.back();
        path.cells.pop_back();
        path.directions.pop_back();
        continue;
      }
      const std::size_t direction = choose(here, open);
      path.cells.push_back(here);
      path.directions.push_back(static_cast<std::uint8_t>(direction));
      here = graph_.next(here, direction);
      visit_[here] = num_paths_;
    }
    return path;
  }

  /// Removes loops: from each cell on, the step to the latest neighboring cell of the path replaces the cells between.
  /// The path may cross itself before, not after.
  void remove_loops(GridPath& path, std::uint32_t goal);

  /// Shortens a path that enters no cell twice. Segments that cost at least as much as an unobstructed shortest path
  /// between their ends are replaced by that path. Its diagonal and straight steps are uniformly mixed, or one kind
  /// precedes the other. The result depends on the side on which the path passes obstacles.
  void shorten(GridPath& path, std::uint32_t goal);

 private:
  const StepGraph& graph_;
  std::vector<std::uint32_t> visit_;     ///< [cell], number of the last path that visited it
  std::vector<std::uint32_t> position_;  ///< [cell], last index in the path
  std::uint32_t num_paths_ = 0;
};

/// Sum of the costs of the steps.
double path_cost(const StepGraph& graph, const GridPath& path);

}  // namespace patrol::plan
