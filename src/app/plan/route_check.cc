#include "app/plan/route_check.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>

#include <fmt/format.h>

namespace patrol::app {
namespace {

/// Point in half cells from the grid's lower-left corner: centers have odd coordinates, corners even ones.
struct Point {
  long x = 0, y = 0;
  friend bool operator==(const Point&, const Point&) = default;
};

Point center_of(Cell cell) { return {.x = 2L * cell.col + 1, .y = 2L * cell.row + 1}; }

/// Converts a point; none if it is neither a center nor a corner.
std::optional<Point> to_half_cell_point(const Eigen::Vector2d& p) {
  const Eigen::Vector2d twice = 2.0 * p;
  if (!twice.allFinite() || twice.cwiseAbs().maxCoeff() > 1e9) return std::nullopt;
  const Point point{.x = std::lround(twice.x()), .y = std::lround(twice.y())};
  const bool is_exact = static_cast<double>(point.x) == twice.x() && static_cast<double>(point.y) == twice.y();
  if (!is_exact || (point.x - point.y) % 2 != 0) return std::nullopt;
  return point;
}

long floor_div(long a, long b) { return a / b - (a % b != 0 && (a < 0) != (b < 0) ? 1 : 0); }
long ceil_div(long a, long b) { return -floor_div(-a, b); }

class Leg {
 public:
  Leg(const Grid<plan::Cost>& costs, Point from, Point to)
      : costs_(costs), low_(from.y <= to.y ? from : to), high_(from.y <= to.y ? to : from) {}

  /// Lethal cell whose closed square the leg meets; with `is_open`, whose inside.
  std::optional<Cell> lethal_cell(bool is_open) const {
    for (long row = floor_div(low_.y, 2) - 1; 2 * row <= high_.y; ++row) {
      const long bottom = std::max(low_.y, 2 * row), top = std::min(high_.y, 2 * row + 2);
      if (bottom > top) continue;
      const bool is_level_inside = low_.y == high_.y && low_.y > 2 * row && low_.y < 2 * row + 2;
      if (is_open && bottom == top && !is_level_inside) continue;
      // Part of the leg between the two heights: from `left` to `right`, in `unit`-ths of a half cell.
      const long unit = std::max(1L, high_.y - low_.y), dx = high_.x - low_.x;
      long left = low_.x * unit + dx * (bottom - low_.y), right = low_.x * unit + dx * (top - low_.y);
      if (low_.y == high_.y) left = low_.x, right = high_.x;
      if (left > right) std::swap(left, right);
      const long cell = 2 * unit;
      // Closed: cell * col <= right and cell * (col + 1) >= left; open: without equality.
      const long first = is_open ? floor_div(left, cell) : ceil_div(left, cell) - 1;
      const long last = is_open ? ceil_div(right, cell) - 1 : floor_div(right, cell);
      for (long col = first; col <= last; ++col) {
        if (is_lethal(col, row)) return Cell{static_cast<int>(col), static_cast<int>(row)};
      }
    }
    return std::nullopt;
  }

  /// Whether the leg passes a corner at which two lethal cells meet, or runs along a side between two.
  bool passes_between_cells() const {
    if (low_.y == high_.y) {
      if (low_.y % 2 != 0) return false;  // through the middles of cells
      const auto [left, right] = std::minmax(low_.x, high_.x);
      for (long x = left + left % 2; x <= right; x += 2) {
        if (is_pinched(x / 2, low_.y / 2)) return true;
      }
      return runs_between(left, right, [&](long along, long side) { return is_lethal(along, low_.y / 2 + side); });
    }
    const auto is_beside = [&](long along, long side) { return is_lethal(low_.x / 2 + side, along); };
    if (low_.x == high_.x && low_.x % 2 == 0 && runs_between(low_.y, high_.y, is_beside)) return true;
    for (long y = low_.y + low_.y % 2; y <= high_.y; y += 2) {
      const long x_parts = low_.x * (high_.y - low_.y) + (high_.x - low_.x) * (y - low_.y),
                 corner = 2 * (high_.y - low_.y);
      if (x_parts % corner == 0 && is_pinched(x_parts / corner, y / 2)) return true;
    }
    return false;
  }

 private:
  bool is_lethal(long col, long row) const {
    const Cell cell{static_cast<int>(col), static_cast<int>(row)};
    return !costs_.contains(cell) || costs_.at(cell) == plan::kLethalCost;
  }
  bool is_pinched(long col, long row) const {
    return (is_lethal(col, row) && is_lethal(col - 1, row - 1)) || (is_lethal(col - 1, row) && is_lethal(col, row - 1));
  }
  template <typename IsLethal>
  static bool runs_between(long begin, long end, const IsLethal& is_lethal) {
    for (long along = floor_div(begin, 2); 2 * along < end; ++along) {
      if (is_lethal(along, 0) && is_lethal(along, -1)) return true;
    }
    return false;
  }

  const Grid<plan::Cost>& costs_;
  Point low_, high_;  ///< ordered by y
};

}  // namespace

std::optional<std::string> validate_route(const Grid<plan::Cost>& costs, const plan::Route& route, Cell start,
                                          Cell goal, bool may_touch) {
  std::vector<Point> points;
  for (const Eigen::Vector2d& p : route.points) {
    const std::optional<Point> point = to_half_cell_point(p);
    if (!point) return fmt::format("turns at {}, {}: must be a cell center or corner", p.x(), p.y());
    points.push_back(*point);
  }
  if (points.empty() || points.front() != center_of(start) || points.back() != center_of(goal))
    return "does not lead from the start to the goal";
  for (std::size_t i = 0; i < points.size(); ++i) {
    const Leg leg(costs, points[i == 0 ? 0 : i - 1], points[i]);
    if (const std::optional<Cell> cell = leg.lethal_cell(may_touch))
      return fmt::format("meets the lethal cell {}, {}", cell->col, cell->row);
    if (may_touch && leg.passes_between_cells())
      return fmt::format("passes between two lethal cells before {}, {}", route.points[i].x(), route.points[i].y());
  }
  return std::nullopt;
}

}  // namespace patrol::app
