#include "plan/routes/grid_walk.h"

#include <numbers>
#include <utility>

namespace patrol::plan {

StepGraph::StepGraph(const Grid<Cost>& costs, const std::array<double, 256>& factors) : width(costs.geometry().width), steps(costs.geometry().size()) {
  for (std::size_t direction = 0; direction < 8; ++direction) offsets[direction] = kGridSteps[direction].row * width + kGridSteps[direction].col;
  for (const Cost cost : costs.values()) cell_factors.push_back(factors[cost]);
  for (std::uint32_t cell = 0; cell < steps.size(); ++cell) {
    if (costs.values()[cell] == kLethalCost) continue;
    for (std::size_t direction = 0; direction < 8; ++direction) {
      if (may_step(costs, cell_of(cell), kGridSteps[direction])) steps[cell] = static_cast<std::uint8_t>(steps[cell] | 1u << direction);
    }
  }
}

double StepGraph::price(std::uint32_t cell, std::size_t direction) const {
  const double length = direction < kFirstDiagonal ? 1.0 : std::numbers::sqrt2;
  return 0.5 * length * (cell_factors[cell] + cell_factors[next(cell, direction)]);
}

std::vector<Eigen::Vector2d> points_of(const StepGraph& graph, const Walk& walk, Cell goal) {
  std::vector<Eigen::Vector2d> points;
  for (const std::uint32_t index : walk.cells) points.emplace_back(graph.cell_of(index).col + 0.5, graph.cell_of(index).row + 0.5);
  points.emplace_back(goal.col + 0.5, goal.row + 0.5);
  return points;
}

Walker::Walker(const StepGraph& graph) : graph_(graph), visit_(graph.steps.size()), position_(graph.steps.size()) {}

void Walker::splice(Walk& walk, std::uint32_t goal) {
  ++num_walks_;
  const auto size = static_cast<std::uint32_t>(walk.cells.size());
  const auto mark = [&](std::uint32_t cell, std::uint32_t position) { visit_[cell] = num_walks_, position_[cell] = position; };
  for (std::uint32_t i = 0; i < size; ++i) mark(walk.cells[i], i);
  mark(goal, size);
  Walk spliced{.cells = {}, .directions = {}, .cost = 0.0, .num_steps = walk.num_steps};
  for (std::uint32_t i = 0; i < size;) {
    const std::uint32_t cell = walk.cells[i];
    i = position_[cell];  // past the loops that come back here
    std::uint32_t farthest = i + 1;
    std::uint8_t by = walk.directions[i];
    for (std::uint8_t direction = 0; direction < 8; ++direction) {
      if (!graph_.has_step(cell, direction)) continue;
      const std::uint32_t other = graph_.next(cell, direction);
      if (visit_[other] == num_walks_ && position_[other] > farthest) farthest = position_[other], by = direction;
    }
    spliced.cells.push_back(cell);
    spliced.directions.push_back(by);
    i = farthest;
  }
  walk = std::move(spliced);
}

double cost_of(const StepGraph& graph, const Walk& walk) {
  double cost = 0.0;
  for (std::size_t i = 0; i < walk.cells.size(); ++i) cost += graph.price(walk.cells[i], walk.directions[i]);
  return cost;
}

}  // namespace patrol::plan
