#include "plan/routes/theta_star.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include "plan/routes/line_of_sight.h"

namespace patrol::plan {
namespace {

double distance(Cell a, Cell b) { return std::hypot(a.col - b.col, a.row - b.row); }

}  // namespace

void ThetaStar::search(const Grid<Cost>& costs, Cell start, Cell goal, Route& route) {
  const GridGeometry& geometry = costs.geometry();
  if (nodes_.geometry().width != geometry.width || nodes_.geometry().height != geometry.height) {
    nodes_ = Grid<Node>(geometry);
    num_searches_ = 0;
  }
  ++num_searches_;
  open_ = {{.estimate = distance(start, goal), .cost = 0.0, .cell = start}};
  nodes_.at(start) = {.cost = 0.0, .parent = start, .search = num_searches_, .is_closed = false};
  route.num_iterations = 1;
  while (!open_.empty()) {
    std::pop_heap(open_.begin(), open_.end());
    const Cell cell = open_.back().cell;
    open_.pop_back();
    if (nodes_.at(cell).is_closed) continue;  // reached at a lower cost before
    nodes_.at(cell).is_closed = true;
    ++route.num_expanded;
    if (cell == goal) {
      route.history = {nodes_.at(cell).cost};
      for (Cell corner = goal;; corner = nodes_.at(corner).parent) {
        route.points.emplace_back(corner.col + 0.5, corner.row + 0.5);
        if (corner == start) break;
      }
      std::reverse(route.points.begin(), route.points.end());
      return;
    }
    expand(costs, cell, goal);
  }
}

void ThetaStar::expand(const Grid<Cost>& costs, Cell cell, Cell goal) {
  const Node here = nodes_.at(cell);
  for (const GridStep step : kGridSteps) {
    if (!is_valid_step(costs, cell, step)) continue;
    const Cell next{cell.col + step.col, cell.row + step.row};
    Node& node = nodes_.at(next);
    const bool is_new = node.search != num_searches_;
    if (!is_new && node.is_closed) continue;

    Node reached{.cost = here.cost + *line_cost(costs, factors(), cell, next),
                 .parent = cell,
                 .search = num_searches_,
                 .is_closed = false};
    // With cost weights the line may cost more than the path through the neighbors; without weights it never does.
    const double at_least = nodes_.at(here.parent).cost + distance(here.parent, next);
    if (here.parent != cell && (is_new || at_least < node.cost)) {
      const std::optional<double> line = line_cost(costs, factors(), here.parent, next);
      const double cost = line ? nodes_.at(here.parent).cost + *line : reached.cost;
      if (line && cost <= reached.cost + 1e-12 * reached.cost) reached.cost = cost, reached.parent = here.parent;
    }
    if (!is_new && node.cost <= reached.cost) continue;
    node = reached;
    open_.push_back({.estimate = reached.cost + distance(next, goal), .cost = reached.cost, .cell = next});
    std::push_heap(open_.begin(), open_.end());
  }
}

}  // namespace patrol::plan
