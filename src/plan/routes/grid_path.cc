#include "plan/routes/grid_path.h"

#include <algorithm>
#include <cstdlib>
#include <numbers>
#include <optional>
#include <utility>

#include "plan/routes/planned_path.h"

namespace patrol::plan {
namespace {

enum class Mix { kEven, kDiagonalFirst, kStraightFirst };

std::size_t direction_of(int col, int row) {
  const auto* const found = std::find_if(kGridSteps.begin(), kGridSteps.end(),
                                         [&](GridStep step) { return step.col == col && step.row == row; });
  return static_cast<std::size_t>(found - kGridSteps.begin());
}

/// Appends an unobstructed shortest path from a cell to another to `path`; returns its cost, or none if it is blocked.
std::optional<double> append_open_path(const StepGraph& graph, std::uint32_t from, std::uint32_t to, Mix mix,
                                       GridPath& path) {
  const Cell a = graph.cell_of(from), b = graph.cell_of(to);
  const int dx = b.col - a.col, dy = b.row - a.row, longer = std::max(std::abs(dx), std::abs(dy)),
            shorter = std::min(std::abs(dx), std::abs(dy));
  const int sign_x = std::clamp(dx, -1, 1), sign_y = std::clamp(dy, -1, 1);
  const std::size_t diagonal = direction_of(sign_x, sign_y);
  const std::size_t straight = std::abs(dx) >= std::abs(dy) ? direction_of(sign_x, 0) : direction_of(0, sign_y);
  double cost = 0.0;
  std::uint32_t here = from;
  for (int i = 0; i < longer; ++i) {
    bool is_diagonal = i < shorter;
    if (mix == Mix::kStraightFirst) is_diagonal = i >= longer - shorter;
    if (mix == Mix::kEven)
      is_diagonal = (2 * i * shorter + longer) / (2 * longer) != (2 * (i + 1) * shorter + longer) / (2 * longer);
    const std::size_t direction = is_diagonal ? diagonal : straight;
    if (!graph.has_step(here, direction)) return std::nullopt;
    cost += graph.step_cost(here, direction);
    path.cells.push_back(here);
    path.directions.push_back(static_cast<std::uint8_t>(direction));
    here = graph.next(here, direction);
  }
  return here == to ? std::optional(cost) : std::nullopt;
}

}  // namespace

StepGraph::StepGraph(const Grid<Cost>& costs, const std::array<double, 256>& factors)
    : width(costs.geometry().width), steps(costs.geometry().size()) {
  for (std::size_t direction = 0; direction < 8; ++direction)
    offsets[direction] = kGridSteps[direction].row * width + kGridSteps[direction].col;
  for (const Cost cost : costs.values()) cell_factors.push_back(factors[cost]);
  for (std::uint32_t cell = 0; cell < steps.size(); ++cell) {
    if (costs.values()[cell] == kLethalCost) continue;
    for (std::size_t direction = 0; direction < 8; ++direction) {
      if (is_valid_step(costs, cell_of(cell), kGridSteps[direction]))
        steps[cell] = static_cast<std::uint8_t>(steps[cell] | 1u << direction);
    }
  }
}

double StepGraph::step_cost(std::uint32_t cell, std::size_t direction) const {
  const double length = direction < kFirstDiagonal ? 1.0 : std::numbers::sqrt2;
  return 0.5 * length * (cell_factors[cell] + cell_factors[next(cell, direction)]);
}

std::vector<Eigen::Vector2d> to_points(const StepGraph& graph, const GridPath& path, Cell goal) {
  std::vector<Eigen::Vector2d> points;
  for (const std::uint32_t index : path.cells)
    points.emplace_back(graph.cell_of(index).col + 0.5, graph.cell_of(index).row + 0.5);
  points.emplace_back(goal.col + 0.5, goal.row + 0.5);
  return points;
}

GridPathBuilder::GridPathBuilder(const StepGraph& graph)
    : graph_(graph), visit_(graph.steps.size()), position_(graph.steps.size()) {}

void GridPathBuilder::remove_loops(GridPath& path, std::uint32_t goal) {
  ++num_paths_;
  const auto size = static_cast<std::uint32_t>(path.cells.size());
  const auto mark = [&](std::uint32_t cell, std::uint32_t position) {
    visit_[cell] = num_paths_, position_[cell] = position;
  };
  for (std::uint32_t i = 0; i < size; ++i) mark(path.cells[i], i);
  mark(goal, size);
  GridPath without_loops{.cells = {}, .directions = {}, .cost = 0.0, .num_steps = path.num_steps};
  for (std::uint32_t i = 0; i < size;) {
    const std::uint32_t cell = path.cells[i];
    i = position_[cell];  // skips loops back to this cell
    std::uint32_t latest = i + 1;
    std::uint8_t by = path.directions[i];
    for (std::uint8_t direction = 0; direction < 8; ++direction) {
      if (!graph_.has_step(cell, direction)) continue;
      const std::uint32_t other = graph_.next(cell, direction);
      if (visit_[other] == num_paths_ && position_[other] > latest) latest = position_[other], by = direction;
    }
    without_loops.cells.push_back(cell);
    without_loops.directions.push_back(by);
    i = latest;
  }
  path = std::move(without_loops);
}

void GridPathBuilder::shorten(GridPath& path, std::uint32_t goal) {
  constexpr double kLess = 1e-9;
  const std::size_t count = path.cells.size() + 1;  // including the goal
  std::vector<double> cost_to{0.0};                 // [cell of the path], cost from the start
  for (std::size_t i = 0; i + 1 < count; ++i)
    cost_to.push_back(cost_to.back() + graph_.step_cost(path.cells[i], path.directions[i]));
  const auto cell = [&](std::size_t i) { return i + 1 < count ? path.cells[i] : goal; };
  GridPath segment;
  const auto is_better = [&](std::size_t from, std::size_t to) {
    for (const Mix mix : {Mix::kEven, Mix::kDiagonalFirst, Mix::kStraightFirst}) {
      segment.cells.clear(), segment.directions.clear();
      const std::optional<double> cost = append_open_path(graph_, cell(from), cell(to), mix, segment);
      if (cost && *cost <= cost_to[to] - cost_to[from] + kLess) return true;
    }
    return false;
  };
  GridPath shortened{.cells = {}, .directions = {}, .cost = 0.0, .num_steps = path.num_steps};
  const std::vector<std::size_t> kept = join_points(count, is_better);
  for (std::size_t k = 1; k < kept.size(); ++k) {
    if (kept[k] == kept[k - 1] + 1 || !is_better(kept[k - 1], kept[k])) {
      segment.cells.assign(path.cells.begin() + static_cast<std::ptrdiff_t>(kept[k - 1]),
                           path.cells.begin() + static_cast<std::ptrdiff_t>(kept[k]));
      segment.directions.assign(path.directions.begin() + static_cast<std::ptrdiff_t>(kept[k - 1]),
                                path.directions.begin() + static_cast<std::ptrdiff_t>(kept[k]));
    }
    shortened.cells.insert(shortened.cells.end(), segment.cells.begin(), segment.cells.end());
    shortened.directions.insert(shortened.directions.end(), segment.directions.begin(), segment.directions.end());
  }
  path = std::move(shortened);
}

double path_cost(const StepGraph& graph, const GridPath& path) {
  double cost = 0.0;
  for (std::size_t i = 0; i < path.cells.size(); ++i) cost += graph.step_cost(path.cells[i], path.directions[i]);
  return cost;
}

}  // namespace patrol::plan
