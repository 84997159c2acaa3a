#include "plan/astar.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <functional>
#include <limits>
#include <optional>

namespace patrol::plan {
namespace {

constexpr std::uint32_t kStraight = 1000;  ///< price of one cell's length; leaves room for routes of 10^6 cells
constexpr std::uint32_t kDiagonal = 1414;

struct Step {
  int col, row;
};
constexpr Step kSteps[8] = {{1, 0}, {0, 1}, {-1, 0}, {0, -1}, {1, 1}, {-1, 1}, {-1, -1}, {1, -1}};
constexpr int kFirstDiagonal = 4;

std::uint32_t octile(Cell a, Cell b) {
  const auto dx = static_cast<std::uint32_t>(std::abs(a.col - b.col));
  const auto dy = static_cast<std::uint32_t>(std::abs(a.row - b.row));
  return kStraight * std::max(dx, dy) + (kDiagonal - kStraight) * std::min(dx, dy);
}

std::size_t index_of(const GridGeometry& geometry, Cell cell) {
  return static_cast<std::size_t>(cell.row) * static_cast<std::size_t>(geometry.width) +
         static_cast<std::size_t>(cell.col);
}

}  // namespace

std::optional<Cell> nearest_passable(const Grid<Cost>& costs, const Eigen::Vector2d& p, double radius_m) {
  const GridGeometry& grid = costs.geometry();
  const Cell center = grid.cell_at(p);
  if (costs.contains(center) && costs.at(center) != kLethalCost) return center;
  const int reach = static_cast<int>(std::ceil(radius_m / grid.resolution_m));
  std::optional<Cell> nearest;
  double nearest_m = radius_m;
  for (int row = center.row - reach; row <= center.row + reach; ++row) {
    for (int col = center.col - reach; col <= center.col + reach; ++col) {
      const Cell cell{col, row};
      if (!costs.contains(cell) || costs.at(cell) == kLethalCost) continue;
      const double distance_m = (grid.center_of(cell) - p).norm();
      if (distance_m > nearest_m || (nearest && distance_m == nearest_m)) continue;
      nearest = cell;
      nearest_m = distance_m;
    }
  }
  return nearest;
}

AstarPlanner::AstarPlanner(const AstarSettings& settings) : settings_(settings) {
  validate(settings_, "astar");
  for (int cost = 0; cost < 256; ++cost) {
    const double factor = 1.0 + settings_.cost_weight * std::min<double>(cost, kMaxPassableCost) / kMaxPassableCost;
    straight_[cost] = static_cast<std::uint32_t>(std::lround(kStraight * factor));
    diagonal_[cost] = static_cast<std::uint32_t>(std::lround(kDiagonal * factor));
  }
}

PlanResult AstarPlanner::plan(const Grid<Cost>& costs, const Eigen::Vector2d& p_map_start,
                              const Eigen::Vector2d& p_map_goal) {
  const GridGeometry& grid = costs.geometry();
  PlanResult result;
  const std::optional<Cell> start = nearest_passable(costs, p_map_start, settings_.start_tolerance_m);
  if (!start) {
    result.status = PlanStatus::kStartBlocked;
    return result;
  }
  const std::optional<Cell> goal = nearest_passable(costs, p_map_goal, settings_.goal_tolerance_m);
  if (!goal) {
    result.status = PlanStatus::kGoalBlocked;
    return result;
  }
  result.is_goal_moved = *goal != grid.cell_at(p_map_goal);
  if (!search(costs, *start, *goal, result)) return result;

  // The ends are the exact points, unless the goal had to move.
  for (const Cell cell : trace_back(grid, *start, *goal)) result.points_m.push_back(grid.center_of(cell));
  const bool is_start_moved = *start != grid.cell_at(p_map_start);
  if (is_start_moved || result.points_m.size() == 1) {
    result.points_m.insert(result.points_m.begin(), p_map_start);
  } else {
    result.points_m.front() = p_map_start;
  }
  if (!result.is_goal_moved) result.points_m.back() = p_map_goal;
  for (std::size_t i = 1; i < result.points_m.size(); ++i) {
    result.length_m += (result.points_m[i] - result.points_m[i - 1]).norm();
  }
  result.status = PlanStatus::kFound;
  return result;
}

bool AstarPlanner::search(const Grid<Cost>& costs, Cell start, Cell goal, PlanResult& result) {
  const GridGeometry& grid = costs.geometry();
  const auto width = static_cast<std::size_t>(grid.width);
  nodes_.resize(grid.size());
  ++num_searches_;
  open_.clear();
  nodes_[index_of(grid, start)] = {.cost = 0, .search = num_searches_, .came_by = 0, .is_closed = false};
  open_.push_back(static_cast<std::uint64_t>(octile(start, goal)) << 32 | index_of(grid, start));
  while (!open_.empty()) {
    std::pop_heap(open_.begin(), open_.end(), std::greater<>());
    const std::size_t index = open_.back() & 0xffffffffu;
    open_.pop_back();
    if (nodes_[index].is_closed) continue;  // reached cheaper before
    nodes_[index].is_closed = true;
    ++result.num_expanded;
    const Cell cell{static_cast<int>(index % width), static_cast<int>(index / width)};
    if (cell == goal) {
      result.cost_m = grid.resolution_m * nodes_[index].cost / kStraight;
      return true;
    }
    expand(costs, cell, goal);
  }
  return false;
}

void AstarPlanner::expand(const Grid<Cost>& costs, Cell cell, Cell goal) {
  const GridGeometry& grid = costs.geometry();
  const std::uint32_t cost_here = nodes_[index_of(grid, cell)].cost;
  for (int direction = 0; direction < 8; ++direction) {
    const Step step = kSteps[direction];
    const Cell next{cell.col + step.col, cell.row + step.row};
    if (!grid.contains(next)) continue;
    const Cost cost = costs.at(next);
    if (cost == kLethalCost) continue;
    const bool is_diagonal = direction >= kFirstDiagonal;
    if (is_diagonal && (costs.at({next.col, cell.row}) == kLethalCost || costs.at({cell.col, next.row}) == kLethalCost)) {
      continue;
    }
    const std::uint32_t cost_there = cost_here + (is_diagonal ? diagonal_[cost] : straight_[cost]);
    const std::size_t index = index_of(grid, next);
    Node& node = nodes_[index];
    if (node.search == num_searches_ && node.cost <= cost_there) continue;
    node = {.cost = cost_there,
            .search = num_searches_,
            .came_by = static_cast<std::uint8_t>(direction),
            .is_closed = false};
    open_.push_back(static_cast<std::uint64_t>(cost_there + octile(next, goal)) << 32 | index);
    std::push_heap(open_.begin(), open_.end(), std::greater<>());
  }
}

std::vector<Cell> AstarPlanner::trace_back(const GridGeometry& geometry, Cell start, Cell goal) const {
  std::vector<Cell> cells{goal};
  while (cells.back() != start) {
    const Cell cell = cells.back();
    const Step step = kSteps[nodes_[index_of(geometry, cell)].came_by];
    cells.push_back({cell.col - step.col, cell.row - step.row});
  }
  std::reverse(cells.begin(), cells.end());
  return cells;
}

}  // namespace patrol::plan
