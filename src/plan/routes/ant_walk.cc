#include "plan/routes/ant_walk.h"

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

Walk Walker::walk(const std::vector<double>& weights, std::uint32_t start, std::uint32_t goal, bool splices, RandomSequence random) {
  ++num_walks_;
  visit_[start] = num_walks_;
  Walk walk;
  for (std::uint32_t here = start; here != goal; ++walk.num_steps) {
    std::array<double, 8> up_to{};  // sums of weights
    double total = 0.0;
    for (std::size_t direction = 0; direction < 8; ++direction) {
      if (graph_.has_step(here, direction) && visit_[graph_.next(here, direction)] != num_walks_) total += weights[8 * std::size_t{here} + direction];
      up_to[direction] = total;
    }
    if (total == 0.0) {  // a dead end
      if (walk.cells.empty()) return walk;
      here = walk.cells.back();
      walk.cells.pop_back();
      walk.directions.pop_back();
      continue;
    }
    const double drawn = total * random.uniform();
    std::size_t direction = 0;
    while (up_to[direction] <= drawn && up_to[direction] < total) ++direction;
    walk.cells.push_back(here);
    walk.directions.push_back(static_cast<std::uint8_t>(direction));
    here = graph_.next(here, direction);
    visit_[here] = num_walks_;
  }
  if (splices) splice(walk, goal);
  for (std::size_t i = 0; i < walk.cells.size(); ++i) walk.cost += graph_.price(walk.cells[i], walk.directions[i]);
  return walk;
}

void Walker::splice(Walk& walk, std::uint32_t goal) {
  ++num_walks_;
  const auto size = static_cast<std::uint32_t>(walk.cells.size());
  const auto mark = [&](std::uint32_t cell, std::uint32_t position) { visit_[cell] = num_walks_, position_[cell] = position; };
  for (std::uint32_t i = 0; i < size; ++i) mark(walk.cells[i], i);
  mark(goal, size);
  Walk spliced{.cells = {}, .directions = {}, .cost = 0.0, .num_steps = walk.num_steps};
  for (std::uint32_t i = 0; i < size;) {
    const std::uint32_t cell = walk.cells[i];
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

}  // namespace patrol::plan
