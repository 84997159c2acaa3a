#include "plan/routes/visibility_graph.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <queue>

namespace patrol::plan {
namespace {

constexpr double kNotReached = std::numeric_limits<double>::infinity();

/// Cells around a point, mirrored into one of the four quadrants: there, lines go up and to the right.
class Quadrant {
 public:
  Quadrant(const Grid<Cost>& costs, HalfCellPoint origin, int sign_x, int sign_y)
      : costs_(costs), sign_x_(sign_x), sign_y_(sign_y), origin_{.x = sign_x * origin.x, .y = sign_y * origin.y} {}

  HalfCellPoint origin() const { return origin_; }
  HalfCellPoint to_quadrant(HalfCellPoint p) const { return {.x = sign_x_ * p.x, .y = sign_y_ * p.y}; }
  HalfCellPoint to_grid(HalfCellPoint p) const { return to_quadrant(p); }
  /// Whether the cell with this lower-left corner in the quadrant, in cells, is free.
  bool is_free(int col, int row) const {
    const Cell cell{sign_x_ > 0 ? col : -col - 1, sign_y_ > 0 ? row : -row - 1};
    return costs_.contains(cell) && costs_.at(cell) != kLethalCost;
  }
  /// Column of the first cell that a line from the origin enters.
  int first_col() const { return floor_half(origin_.x); }
  int first_row() const { return floor_half(origin_.y); }

 private:
  static int floor_half(int value) { return value >= 0 ? value / 2 : -((1 - value) / 2); }

  const Grid<Cost>& costs_;
  int sign_x_, sign_y_;
  HalfCellPoint origin_;
};

/// Visibility along a column or a row, from `first` to `end`, half cells. `is_free(along, side)` tests the cells on
/// both sides of the line, or on it.
template <typename IsFree>
bool is_visible_along_axis(int first, int end, IsFree is_free) {
  for (int along = first; 2 * along < end; ++along) {
    const bool here[2] = {is_free(along, 0), is_free(along, -1)};
    if (!here[0] && !here[1]) return false;
    if (2 * (along + 1) >= end) break;
    // The line would change sides between two cells that meet at a corner.
    if (here[0] != here[1] && is_free(along + 1, 0) == here[1] && is_free(along + 1, -1) == here[0]) return false;
  }
  return true;
}

bool is_visible_up_right(const Quadrant& quadrant, HalfCellPoint to) {
  const HalfCellPoint from = quadrant.origin();
  const long dx = to.x - from.x, dy = to.y - from.y;
  int col = quadrant.first_col(), row = quadrant.first_row();
  for (;;) {
    if (!quadrant.is_free(col, row)) return false;
    // The line leaves the cell through its right side at (x - from.x) / dx, through its upper side at (y - from.y) /
    // dy.
    const long x = 2L * (col + 1) - from.x, y = 2L * (row + 1) - from.y;
    if (x >= dx && y >= dy) return true;
    const bool by_right = x * dy <= y * dx, by_top = y * dx <= x * dy;
    if (by_right && by_top && !quadrant.is_free(col + 1, row) && !quadrant.is_free(col, row + 1)) return false;
    col += by_right ? 1 : 0;
    row += by_top ? 1 : 0;
  }
}

/// Visibility graph of one grid, with the state of the search.
class VisibilitySearch {
 public:
  VisibilitySearch(const Grid<Cost>& costs, Cell start, Cell goal)
      : costs_(costs),
        start_(center(start)),
        goal_(center(goal)),
        width_(2 * costs.geometry().width + 1),
        nodes_(static_cast<std::size_t>(width_) * static_cast<std::size_t>(2 * costs.geometry().height + 1)) {}

  void run(Route& route) {
    route.num_iterations = 1;
    relax(start_, 0.0, start_);
    while (!open_.empty()) {
      const HalfCellPoint point = open_.top().point;
      open_.pop();
      if (node(point).is_closed) continue;
      node(point).is_closed = true;
      ++route.num_expanded;
      if (point == goal_) {
        trace_back(route);
        return;
      }
      for (const int sign_x : {1, -1}) {
        for (const int sign_y : {1, -1}) spread(point, Quadrant(costs_, point, sign_x, sign_y));
      }
    }
  }

 private:
  struct Node {
    double length = kNotReached;  ///< from the start, half cells
    HalfCellPoint parent{};
    HalfCellPoint checked_from{.x = -1, .y = -1};  ///< last corner from which visibility was checked
    bool is_closed = false;
  };
  struct Open {
    double estimate;
    HalfCellPoint point;
    bool operator<(const Open& other) const { return estimate > other.estimate; }
  };
  /// Cone of visible directions, y / (x + y): 0 to the right, 1 up.
  struct Cone {
    double low = 1.0, high = 0.0;
    bool is_empty() const { return low > high; }
    void join(const Cone& other) {
      if (!other.is_empty()) low = std::min(low, other.low), high = std::max(high, other.high);
    }
    /// Part of the cone through a side between two points; x and y are relative to the cone's origin.
    Cone through(double x0, double y0, double x1, double y1) const {
      constexpr double kSlack = 1e-9;  // conservative: corners in the cone are checked exactly afterward
      return {.low = std::max(low, y0 / (x0 + y0) - kSlack), .high = std::min(high, y1 / (x1 + y1) + kSlack)};
    }
  };

  static HalfCellPoint center(Cell cell) { return {.x = 2 * cell.col + 1, .y = 2 * cell.row + 1}; }
  static double distance(HalfCellPoint a, HalfCellPoint b) { return std::hypot(a.x - b.x, a.y - b.y); }
  Node& node(HalfCellPoint p) {
    return nodes_[static_cast<std::size_t>(p.y) * static_cast<std::size_t>(width_) + static_cast<std::size_t>(p.x)];
  }
  bool is_lethal(int col, int row) const {
    return !costs_.contains({col, row}) || costs_.at({col, row}) == kLethalCost;
  }

  /// Direction of the single lethal cell at a corner; none unless there is exactly one, because paths turn only there.
  std::optional<HalfCellPoint> lethal_side(HalfCellPoint corner) const {
    std::optional<HalfCellPoint> side;
    for (const int dx : {-1, 1}) {
      for (const int dy : {-1, 1}) {
        if (!is_lethal((corner.x + dx - 1) / 2, (corner.y + dy - 1) / 2)) continue;
        if (side) return std::nullopt;
        side = HalfCellPoint{.x = dx, .y = dy};
      }
    }
    return side;
  }

  void relax(HalfCellPoint point, double length, HalfCellPoint parent) {
    Node& reached = node(point);
    if (length >= reached.length) return;
    reached.length = length;
    reached.parent = parent;
    open_.push({.estimate = length + distance(point, goal_), .point = point});
  }

  void try_connect(HalfCellPoint from, HalfCellPoint to) {
    Node& target = node(to);
    if (to == from || target.checked_from == from || target.is_closed) return;
    target.checked_from = from;
    const double length = node(from).length + distance(from, to);
    if (length >= target.length) return;
    if (to != goal_) {
      // A path straight toward the corner's lethal cell is not optimal: it would turn away from the cell, not around
      // it.
      const std::optional<HalfCellPoint> side = lethal_side(to);
      if (!side || ((to.x - from.x) * side->x > 0 && (to.y - from.y) * side->y > 0)) return;
    }
    if (is_visible(costs_, from, to)) relax(to, length, from);
  }

  /// Spreads the cones row by row over the cells of a quadrant; each cell receives cones from below and from the left.
  void spread(HalfCellPoint from, const Quadrant& quadrant) {
    const int first_col = quadrant.first_col(), first_row = quadrant.first_row();
    std::vector<Cone>& below = below_;
    below.clear();
    for (int row = first_row;; ++row) {
      bool is_dark = true;
      Cone left;
      for (int i = 0;; ++i) {
        const int col = first_col + i;
        const bool has_below = row > first_row && i < static_cast<int>(below.size());
        if (!has_below && left.is_empty() && i > 0) break;
        const double x = std::max(0, 2 * col - quadrant.origin().x), y = std::max(0, 2 * row - quadrant.origin().y);
        const double far_x = 2 * (col + 1) - quadrant.origin().x, far_y = 2 * (row + 1) - quadrant.origin().y;
        Cone here = row == first_row && i == 0 ? Cone{.low = 0.0, .high = 1.0} : Cone{};
        if (!left.is_empty()) here.join(left.through(x, y, x, far_y));
        if (has_below && !below[static_cast<std::size_t>(i)].is_empty()) {
          here.join(below[static_cast<std::size_t>(i)].through(far_x, y, x, y));
        }
        if (!here.is_empty() && !quadrant.is_free(col, row)) here = {};
        if (i < static_cast<int>(below.size())) below[static_cast<std::size_t>(i)] = here;
        else below.push_back(here);
        left = here;
        if (here.is_empty()) {
          if (row == first_row && i == 0) return;
          continue;
        }
        is_dark = false;
        connect_corners(from, quadrant, col, row);
      }
      while (!below.empty() && below.back().is_empty()) below.pop_back();
      if (is_dark) return;
    }
  }

  void connect_corners(HalfCellPoint from, const Quadrant& quadrant, int col, int row) {
    for (const int dx : {0, 2}) {
      for (const int dy : {0, 2}) try_connect(from, quadrant.to_grid({.x = 2 * col + dx, .y = 2 * row + dy}));
    }
    const HalfCellPoint middle = quadrant.to_grid({.x = 2 * col + 1, .y = 2 * row + 1});
    if (middle == goal_) try_connect(from, goal_);
  }

  void trace_back(Route& route) {
    route.history = {0.5 * node(goal_).length};
    for (HalfCellPoint point = goal_;; point = node(point).parent) {
      route.points.emplace_back(0.5 * point.x, 0.5 * point.y);
      if (point == start_) break;
    }
    std::reverse(route.points.begin(), route.points.end());
  }

  const Grid<Cost>& costs_;
  HalfCellPoint start_, goal_;
  int width_;
  std::vector<Node> nodes_;  ///< [y * width + x], half cells
  std::priority_queue<Open> open_;
  std::vector<Cone> below_;  ///< [column from the first], cones of the row below
};

}  // namespace

bool is_visible(const Grid<Cost>& costs, HalfCellPoint from, HalfCellPoint to) {
  const int dx = to.x - from.x, dy = to.y - from.y;
  if (dx == 0 && dy == 0) return true;
  const Quadrant quadrant(costs, from, dx < 0 ? -1 : 1, dy < 0 ? -1 : 1);
  const HalfCellPoint origin = quadrant.origin(), end = quadrant.to_quadrant(to);
  const int col = quadrant.first_col(), row = quadrant.first_row();
  if (dy == 0) {
    const int between = origin.y % 2 == 0 ? 1 : 0;  // else the line runs through cells, which are on both sides
    return is_visible_along_axis(col, end.x,
                                 [&](int along, int side) { return quadrant.is_free(along, row + between * side); });
  }
  if (dx == 0) {
    const int between = origin.x % 2 == 0 ? 1 : 0;
    return is_visible_along_axis(row, end.y,
                                 [&](int along, int side) { return quadrant.is_free(col + between * side, along); });
  }
  return is_visible_up_right(quadrant, end);
}

void VisibilityGraphPlanner::search(const Grid<Cost>& costs, Cell start, Cell goal, Route& route) {
  VisibilitySearch(costs, start, goal).run(route);
}

}  // namespace patrol::plan
