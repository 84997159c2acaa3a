#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <functional>
#include <limits>
#include <queue>
#include <string>
#include <utility>
#include <vector>

#include "core/random.h"
#include "plan/routes/route_planner.h"

namespace patrol::test {

using plan::Cost, plan::kFreeCost, plan::kLethalCost, plan::kMaxPassableCost;

/// Drawn with the highest row on top: '#' lethal, '.' free, a digit d costs d ninths of the highest passable cost.
inline Grid<Cost> draw(const std::vector<std::string>& drawing) {
  Grid<Cost> costs(
      {.resolution_m = 1.0, .width = static_cast<int>(drawing[0].size()), .height = static_cast<int>(drawing.size())});
  for (int row = 0; row < costs.geometry().height; ++row) {
    for (int col = 0; col < costs.geometry().width; ++col) {
      const char c = drawing[drawing.size() - 1 - static_cast<std::size_t>(row)][static_cast<std::size_t>(col)];
      costs.at({col, row}) = c == '#' ? kLethalCost : c == '.' ? kFreeCost : static_cast<Cost>((c - '0') * 28);
    }
  }
  return costs;
}

/// Up to `max_size` cells a side; a share of up to `max_lethal` lethal, others free or, if `is_priced`, half of them at
/// any cost.
inline Grid<Cost> random_grid(std::uint64_t seed, int max_size = 24, double max_lethal = 0.5, bool is_priced = false) {
  const RandomStream stream(seed, "test/grid");
  const auto side = [&](std::uint64_t tick) { return 2 + static_cast<int>((max_size - 2) * stream.uniform(tick)); };
  Grid<Cost> costs({.resolution_m = 1.0, .width = side(0), .height = side(1)});
  const double lethal_fraction = max_lethal * stream.uniform(2);
  for (std::size_t i = 0; i < costs.values().size(); ++i) {
    const auto priced =
        static_cast<Cost>(is_priced && stream.uniform(4, i) < 0.5 ? kMaxPassableCost * stream.uniform(5, i) : 0.0);
    costs.values()[i] = stream.uniform(3, i) < lethal_fraction ? kLethalCost : priced;
  }
  return costs;
}

/// Two passable cells by chance; the same twice if there is but one, and lethal ones if there is none.
inline std::pair<Cell, Cell> random_ends(const Grid<Cost>& costs, std::uint64_t seed) {
  std::vector<Cell> cells;
  for (int row = 0; row < costs.geometry().height; ++row) {
    for (int col = 0; col < costs.geometry().width; ++col) {
      if (costs.at({col, row}) != kLethalCost) cells.push_back({col, row});
    }
  }
  if (cells.empty()) return {};
  RandomSequence random(RandomStream(seed, "test/ends"), 0);
  const Cell start = cells[random.index(cells.size())];
  return {start, cells[random.index(cells.size())]};
}

/// The slow, obvious version of a shortest route: every cell's length from the start by Dijkstra's algorithm, infinite
/// where there is no way. Its rule for steps is written out anew.
inline Grid<double> lengths_from(const Grid<Cost>& costs, Cell start) {
  Grid<double> lengths(costs.geometry(), std::numeric_limits<double>::infinity());
  using Entry = std::pair<double, std::pair<int, int>>;
  std::priority_queue<Entry, std::vector<Entry>, std::greater<>> open;
  const auto is_free = [&](int col, int row) {
    return costs.contains({col, row}) && costs.at({col, row}) != kLethalCost;
  };
  if (is_free(start.col, start.row)) open.push({0.0, {start.col, start.row}});
  while (!open.empty()) {
    const auto [length, at] = open.top();
    const auto [col, row] = at;
    open.pop();
    if (length >= lengths.at({col, row})) continue;
    lengths.at({col, row}) = length;
    for (int dy = -1; dy <= 1; ++dy) {
      for (int dx = -1; dx <= 1; ++dx) {
        if (is_free(col + dx, row + dy) && is_free(col + dx, row) && is_free(col, row + dy))
          open.push({length + std::hypot(dx, dy), {col + dx, row + dy}});
      }
    }
  }
  return lengths;
}

/// Whether a segment between corners or centres of cells meets a box of them, by separating axes in whole numbers of
/// half cells; independent of visit_line_cells. With `is_open` only the box's inside counts.
inline bool meets_box(const Eigen::Vector2d& from, const Eigen::Vector2d& to, Cell first, Cell last,
                      bool is_open = false) {
  const long ax = std::lround(2.0 * from.x()), ay = std::lround(2.0 * from.y()), bx = std::lround(2.0 * to.x()),
             by = std::lround(2.0 * to.y());
  const long low_x = 2 * first.col, low_y = 2 * first.row, high_x = 2 * last.col + 2, high_y = 2 * last.row + 2;
  const auto is_apart = [&](long low, long high, long box_low, long box_high) {
    return is_open ? high <= box_low || low >= box_high : high < box_low || low > box_high;
  };
  if (is_apart(std::min(ax, bx), std::max(ax, bx), low_x, high_x) ||
      is_apart(std::min(ay, by), std::max(ay, by), low_y, high_y))
    return false;
  const long nx = ay - by, ny = bx - ax, at = nx * ax + ny * ay;  // along the segment's normal
  return !is_apart(at, at, std::min(nx * low_x, nx * high_x) + std::min(ny * low_y, ny * high_y),
                   std::max(nx * low_x, nx * high_x) + std::max(ny * low_y, ny * high_y));
}

/// Whether no leg of a route meets a lethal cell, touching included.
inline bool keeps_clear(const Grid<Cost>& costs, const std::vector<Eigen::Vector2d>& points) {
  for (std::size_t i = 1; i < points.size(); ++i) {
    for (int row = 0; row < costs.geometry().height; ++row) {
      for (int col = 0; col < costs.geometry().width; ++col) {
        if (costs.at({col, row}) == kLethalCost && meets_box(points[i - 1], points[i], {col, row}, {col, row}))
          return false;
      }
    }
  }
  return true;
}

inline double length_of(const std::vector<Eigen::Vector2d>& points) {
  double length = 0.0;
  for (std::size_t i = 1; i < points.size(); ++i) length += (points[i] - points[i - 1]).norm();
  return length;
}

}  // namespace patrol::test
