#include "plan/routes/grid_search.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <numbers>

namespace patrol::plan {
namespace {

constexpr double kCell = 0x1.0p32;  ///< cost of a cell's length
constexpr int kRemainingShift = 24;

}  // namespace

GridSearch::GridSearch(Method method, double cost_weight) : RoutePlanner(cost_weight), method_(method) {
  for (std::size_t cost = 0; cost < factors().size(); ++cost) {
    half_straight_[cost] = static_cast<PathCost>(std::llround(0.5 * kCell * factors()[cost]));
    half_diagonal_[cost] = static_cast<PathCost>(std::llround(0.5 * kCell * std::numbers::sqrt2 * factors()[cost]));
  }
}

void GridSearch::search(const Grid<Cost>& costs, Cell start, Cell goal, Route& route) {
  const auto width = static_cast<std::uint32_t>(costs.geometry().width);
  const auto index_of = [&](Cell cell) {
    return static_cast<std::uint32_t>(cell.row) * width + static_cast<std::uint32_t>(cell.col);
  };
  nodes_.resize(std::max(nodes_.size(), costs.geometry().size()));
  ++num_searches_;
  open_.clear();
  nodes_[index_of(start)] = {.path_cost = 0, .search = num_searches_, .came_by = 0, .is_closed = false};
  push(0, start, goal, index_of(start));
  route.num_iterations = 1;
  while (!open_.empty()) {
    std::pop_heap(open_.begin(), open_.end());
    const std::uint32_t index = open_.back().index;
    open_.pop_back();
    if (nodes_[index].is_closed) continue;  // reached at a lower cost before
    nodes_[index].is_closed = true;
    ++route.num_expanded;
    if (index == index_of(goal)) {
      route.history = {static_cast<double>(nodes_[index].path_cost) / kCell};
      route.points = trace_back(width, start, goal);
      return;
    }
    expand(costs, index, goal);
  }
}

void GridSearch::expand(const Grid<Cost>& costs, std::uint32_t index, Cell goal) {
  const int width = costs.geometry().width, height = costs.geometry().height;
  const Cell cell{static_cast<int>(index) % width, static_cast<int>(index) / width};
  const Cost* const here = costs.values().data() + index;
  const PathCost path_cost_here = nodes_[index].path_cost, half_straight = half_straight_[*here],
                 half_diagonal = half_diagonal_[*here];
  std::array<bool, 4> is_free{};  // straight neighbors, for the diagonals between them
  for (std::size_t direction = 0; direction < kGridSteps.size(); ++direction) {
    const GridStep step = kGridSteps[direction];
    const bool is_diagonal = direction >= kFirstDiagonal;
    if (is_diagonal && !(is_free[direction - kFirstDiagonal] && is_free[(direction - kFirstDiagonal + 1) % 4]))
      continue;
    const Cell next{cell.col + step.col, cell.row + step.row};
    if (next.col < 0 || next.row < 0 || next.col >= width || next.row >= height) continue;
    const int offset = step.row * width + step.col;
    const Cost cost = here[offset];
    if (cost == kLethalCost) continue;
    if (!is_diagonal) is_free[direction] = true;

    const PathCost path_cost =
        path_cost_here + (is_diagonal ? half_diagonal + half_diagonal_[cost] : half_straight + half_straight_[cost]);
    const auto next_index = static_cast<std::uint32_t>(static_cast<int>(index) + offset);
    Node& node = nodes_[next_index];
    if (node.search == num_searches_ && node.path_cost <= path_cost) continue;
    node = {.path_cost = path_cost,
            .search = num_searches_,
            .came_by = static_cast<std::uint8_t>(direction),
            .is_closed = false};
    push(path_cost, next, goal, next_index);
  }
}

void GridSearch::push(PathCost path_cost, Cell cell, Cell goal, std::uint32_t index) {
  PathCost remaining = 0;
  if (method_ == Method::kAstar) {
    const auto dx = static_cast<PathCost>(std::abs(goal.col - cell.col)),
               dy = static_cast<PathCost>(std::abs(goal.row - cell.row));
    const PathCost diagonal = std::min(dx, dy), straight = std::max(dx, dy) - diagonal;
    remaining = 2 * (half_straight_[kFreeCost] * straight + half_diagonal_[kFreeCost] * diagonal);
  }
  open_.push_back({.estimate = path_cost + remaining,
                   .remaining = static_cast<std::uint32_t>(remaining >> kRemainingShift),
                   .index = index});
  std::push_heap(open_.begin(), open_.end());
}

std::vector<Eigen::Vector2d> GridSearch::trace_back(std::uint32_t width, Cell start, Cell goal) const {
  std::vector<Eigen::Vector2d> points;
  for (Cell cell = goal;;) {
    points.emplace_back(cell.col + 0.5, cell.row + 0.5);
    if (cell == start) break;
    const GridStep step =
        kGridSteps[nodes_[static_cast<std::uint32_t>(cell.row) * width + static_cast<std::uint32_t>(cell.col)].came_by];
    cell = {cell.col - step.col, cell.row - step.row};
  }
  std::reverse(points.begin(), points.end());
  return points;
}

}  // namespace patrol::plan
