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
  const auto found = std::find_if(kGridSteps.begin(), kGridSteps.end(), [&](GridStep step) { return step.col == col && step.row == row; });
  return static_cast<std::size_t>(found - kGridSteps.begin());
}

/// Appends an unobstructed shortest path from a cell to another to `walk`; returns its cost, or none if it is blocked.
std::optional<double> open_way(const StepGraph& graph, std::uint32_t from, std::uint32_t to, Mix mix, Walk& walk) {
  const Cell a = graph.cell_of(from), b = graph.cell_of(to);
  const int dx = b.col - a.col, dy = b.row - a.row, longer = std::max(std::abs(dx), std::abs(dy)), shorter = std::min(std::abs(dx), std::abs(dy));
  const int sign_x = (dx > 0) - (dx < 0), sign_y = (dy > 0) - (dy < 0);
  const std::size_t diagonal = direction_of(sign_x, sign_y);
  const std::size_t straight = std::abs(dx) >= std::abs(dy) ? direction_of(sign_x, 0) : direction_of(0, sign_y);
  double price = 0.0;
  std::uint32_t here = from;
  for (int i = 0; i < longer; ++i) {
    bool is_diagonal = i < shorter;
    if (mix == Mix::kStraightFirst) is_diagonal = i >= longer - shorter;
    if (mix == Mix::kEven) is_diagonal = (2 * i * shorter + longer) / (2 * longer) != (2 * (i + 1) * shorter + longer) / (2 * longer);
    const std::size_t direction = is_diagonal ? diagonal : straight;
    if (!graph.has_step(here, direction)) return std::nullopt;
    price += graph.price(here, direction);
    walk.cells.push_back(here);
    walk.directions.push_back(static_cast<std::uint8_t>(direction));
    here = graph.next(here, direction);
  }
  return here == to ? std::optional(price) : std::nullopt;
}

}  // namespace

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
    i = position_[cell];  // skips loops back to this cell
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

void Walker::tighten(Walk& walk, std::uint32_t goal) {
  constexpr double kLess = 1e-9;
  const std::size_t count = walk.cells.size() + 1;  // including the goal
  std::vector<double> cost_to{0.0};                 // [cell of the walk], cost from the start
  for (std::size_t i = 0; i + 1 < count; ++i) cost_to.push_back(cost_to.back() + graph_.price(walk.cells[i], walk.directions[i]));
  const auto cell = [&](std::size_t i) { return i + 1 < count ? walk.cells[i] : goal; };
  Walk way;
  const auto is_better = [&](std::size_t from, std::size_t to) {
    for (const Mix mix : {Mix::kEven, Mix::kDiagonalFirst, Mix::kStraightFirst}) {
      way.cells.clear(), way.directions.clear();
      const std::optional<double> price = open_way(graph_, cell(from), cell(to), mix, way);
      if (price && *price <= cost_to[to] - cost_to[from] + kLess) return true;
    }
    return false;
  };
  Walk tight{.cells = {}, .directions = {}, .cost = 0.0, .num_steps = walk.num_steps};
  const std::vector<std::size_t> kept = join_points(count, is_better);
  for (std::size_t k = 1; k < kept.size(); ++k) {
    if (kept[k] == kept[k - 1] + 1 || !is_better(kept[k - 1], kept[k])) {
      way.cells.assign(walk.cells.begin() + static_cast<std::ptrdiff_t>(kept[k - 1]), walk.cells.begin() + static_cast<std::ptrdiff_t>(kept[k]));
      way.directions.assign(walk.directions.begin() + static_cast<std::ptrdiff_t>(kept[k - 1]), walk.directions.begin() + static_cast<std::ptrdiff_t>(kept[k]));
    }
    tight.cells.insert(tight.cells.end(), way.cells.begin(), way.cells.end());
    tight.directions.insert(tight.directions.end(), way.directions.begin(), way.directions.end());
  }
  walk = std::move(tight);
}

double cost_of(const StepGraph& graph, const Walk& walk) {
  double cost = 0.0;
  for (std::size_t i = 0; i < walk.cells.size(); ++i) cost += graph.price(walk.cells[i], walk.directions[i]);
  return cost;
}

}  // namespace patrol::plan
