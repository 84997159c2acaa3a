#include "plan/maneuvers/goal_distance.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <queue>
#include <vector>

namespace patrol::plan {
namespace {

constexpr double kBlock_m = 0.2;
constexpr float kInfinity = std::numeric_limits<float>::infinity();

Grid<Cost> lowest_of_blocks(const Grid<Cost>& costs) {
  const GridGeometry& fine = costs.geometry();
  const int size = std::max(1, static_cast<int>(std::lround(kBlock_m / fine.resolution_m)));
  GridGeometry coarse = fine;
  coarse.resolution_m = size * fine.resolution_m;
  coarse.width = (fine.width + size - 1) / size;
  coarse.height = (fine.height + size - 1) / size;
  Grid<Cost> blocks(coarse, kLethalCost);
  for (int row = 0; row < fine.height; ++row) {
    for (int col = 0; col < fine.width; ++col) {
      Cost& block = blocks.at({.col = col / size, .row = row / size});
      block = std::min(block, costs.at({.col = col, .row = row}));
    }
  }
  return blocks;
}

}  // namespace

GoalDistance::GoalDistance(const Grid<Cost>& costs, const Eigen::Vector2d& p_map_goal, double cost_weight) {
  const Grid<Cost> blocks = lowest_of_blocks(costs);
  const GridGeometry& geometry = blocks.geometry();
  distance_m_ = Grid<float>(geometry, kInfinity);
  const Cell goal = geometry.cell_at(p_map_goal);
  if (!geometry.contains(goal)) return;
  struct Entry {
    float distance_m;
    int col, row;
    bool operator>(const Entry& other) const {
      if (distance_m != other.distance_m) return distance_m > other.distance_m;
      return row != other.row ? row > other.row : col > other.col;
    }
  };
  std::priority_queue<Entry, std::vector<Entry>, std::greater<>> open;
  distance_m_.at(goal) = 0.0F;
  open.push({0.0F, goal.col, goal.row});
  while (!open.empty()) {
    const Entry entry = open.top();
    open.pop();
    if (entry.distance_m > distance_m_.at({.col = entry.col, .row = entry.row})) continue;
    ++num_expanded_;
    for (int dc = -1; dc <= 1; ++dc) {
      for (int dr = -1; dr <= 1; ++dr) {
        const Cell next{.col = entry.col + dc, .row = entry.row + dr};
        if ((dc == 0 && dr == 0) || !geometry.contains(next) || blocks.at(next) == kLethalCost) continue;
        const double weight = 1.0 + cost_weight * blocks.at(next) / kMaxPassableCost;
        const auto distance_m =
            static_cast<float>(entry.distance_m + weight * geometry.resolution_m * std::hypot(dc, dr));
        if (distance_m >= distance_m_.at(next)) continue;
        distance_m_.at(next) = distance_m;
        open.push({distance_m, next.col, next.row});
      }
    }
  }
}

double GoalDistance::at(const Eigen::Vector2d& p_map) const {
  const Cell cell = distance_m_.geometry().cell_at(p_map);
  return distance_m_.contains(cell) ? distance_m_.at(cell) : std::numeric_limits<double>::infinity();
}

}  // namespace patrol::plan
