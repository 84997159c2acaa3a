#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "core/random.h"
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

/// A way through the graph without loops: [i] leaves `cells[i]` by `directions[i]`; the goal is not among the cells.
struct Walk {
  std::vector<std::uint32_t> cells;
  std::vector<std::uint8_t> directions;
  double cost = 0.0;
  std::int64_t num_steps = 0;  ///< taken, with those back
};

/// Centres of its cells.
std::vector<Eigen::Vector2d> points_of(const StepGraph& graph, const Walk& walk, Cell goal);

/// Walks by chance, one walk after the other; holds its work space.
class Walker {
 public:
  explicit Walker(const StepGraph& graph);

  /// Chooses among the steps into cells not yet visited with probability proportional to `weights` [cell * 8 + direction]; where there is none, it
  /// goes back. Returns no cells if it comes back to the start so: there is no way. With `splices`, a step from a cell to a later one beside it
  /// replaces what lies between.
  Walk walk(const std::vector<double>& weights, std::uint32_t start, std::uint32_t goal, bool splices, RandomSequence random);

 private:
  void splice(Walk& walk, std::uint32_t goal);

  const StepGraph& graph_;
  std::vector<std::uint32_t> visit_;     ///< [cell] the walk that was here last
  std::vector<std::uint32_t> position_;  ///< [cell] in the walk, where it is
  std::uint32_t num_walks_ = 0;
};

}  // namespace patrol::plan
