#include "plan/routes/route_planner.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include <Eigen/Geometry>
#include <fmt/format.h>

#include "core/error.h"
#include "core/geometry/segment.h"
#include "plan/routes/line_of_sight.h"

namespace patrol::plan {
namespace {

constexpr double kMaxCostWeight = 50.0;

double length_of(const std::vector<Eigen::Vector2d>& points) {
  double straight = 0.0, diagonal = 0.0, other = 0.0;  // separate sums: the first two are integers without rounding
  for (std::size_t i = 1; i < points.size(); ++i) {
    const Eigen::Vector2d d = (points[i] - points[i - 1]).cwiseAbs();
    if (d.x() == 0.0 || d.y() == 0.0) straight += d.sum();
    else if (d.x() == d.y()) diagonal += d.x();
    else other += d.norm();
  }
  return straight + std::numbers::sqrt2 * diagonal + other;
}

/// Distance from a segment to a square that it does not cross; the minimum is at an end of the segment or a corner of
/// the square.
double distance_to_box(const Eigen::Vector2d& from, const Eigen::Vector2d& to, const Eigen::AlignedBox2d& box) {
  double min_distance = std::min(box.exteriorDistance(from), box.exteriorDistance(to));
  for (int corner = 0; corner < 4; ++corner) {
    min_distance = std::min(
        min_distance, distance_to_segment(box.corner(static_cast<Eigen::AlignedBox2d::CornerType>(corner)), from, to));
  }
  return min_distance;
}

/// Distance from the bounding box of a segment to a cell's square: a fast lower bound of the segment's distance.
double gap(const Eigen::Vector2d& from, const Eigen::Vector2d& to, int col, int row) {
  const double dx = std::max({0.0, col - std::max(from.x(), to.x()), std::min(from.x(), to.x()) - col - 1.0});
  const double dy = std::max({0.0, row - std::max(from.y(), to.y()), std::min(from.y(), to.y()) - row - 1.0});
  return std::sqrt(dx * dx + dy * dy);
}

}  // namespace

Cell cell_of(const Eigen::Vector2d& point) {
  return {static_cast<int>(std::floor(point.x())), static_cast<int>(std::floor(point.y()))};
}

int iterations_to_convergence(const std::vector<double>& history, double tolerance) {
  if (history.empty() || !std::isfinite(history.back())) return 0;
  const double enough = history.back() * (1.0 + tolerance);
  return 1 +
         static_cast<int>(std::find_if(history.begin(), history.end(), [&](double cost) { return cost <= enough; }) -
                          history.begin());
}

std::vector<Eigen::Vector2d> to_meters(const GridGeometry& geometry, const std::vector<Eigen::Vector2d>& points) {
  std::vector<Eigen::Vector2d> points_m;
  for (const Eigen::Vector2d& point : points) points_m.emplace_back(geometry.origin_m + geometry.resolution_m * point);
  return points_m;
}

double compute_clearance(const Grid<Cost>& costs, const std::vector<Eigen::Vector2d>& points, double at_most) {
  double min_distance = at_most;
  for (std::size_t i = 0; i < points.size(); ++i) {
    const Eigen::Vector2d &from = points[i], &to = points[std::min(i + 1, points.size() - 1)];
    // Pieces of at most one cell, and for each the cells that could be nearer than the minimum so far.
    const int pieces = std::max(1, static_cast<int>(std::ceil((to - from).cwiseAbs().maxCoeff())));
    for (int k = 0; k < pieces; ++k) {
      const Eigen::Vector2d a = from + (to - from) * k / pieces, b = from + (to - from) * (k + 1) / pieces;
      const Cell low = cell_of(a.cwiseMin(b).array() - min_distance),
                 high = cell_of(a.cwiseMax(b).array() + min_distance);
      for (int row = std::max(0, low.row); row <= std::min(costs.geometry().height - 1, high.row); ++row) {
        for (int col = std::max(0, low.col); col <= std::min(costs.geometry().width - 1, high.col); ++col) {
          if (costs.at({col, row}) != kLethalCost || gap(a, b, col, row) >= min_distance) continue;
          min_distance = std::min(
              min_distance, distance_to_box(a, b, {Eigen::Vector2d(col, row), Eigen::Vector2d(col + 1, row + 1)}));
        }
      }
    }
  }
  return min_distance;
}

bool is_valid_step(const Grid<Cost>& costs, Cell from, GridStep step) {
  const Cell to{from.col + step.col, from.row + step.row};
  if (!costs.contains(to) || costs.at(to) == kLethalCost) return false;
  return step.col == 0 || step.row == 0 ||
         (costs.at({to.col, from.row}) != kLethalCost && costs.at({from.col, to.row}) != kLethalCost);
}

std::vector<Cell> reachable_cells(const Grid<Cost>& costs, Cell start) {
  Grid<std::uint8_t> is_reached(costs.geometry(), 0);
  std::vector<Cell> reached{start};
  is_reached.at(start) = 1;
  for (std::size_t i = 0; i < reached.size(); ++i) {
    for (const GridStep step : kGridSteps) {
      const Cell next{reached[i].col + step.col, reached[i].row + step.row};
      if (!is_valid_step(costs, reached[i], step) || is_reached.at(next) != 0) continue;
      is_reached.at(next) = 1;
      reached.push_back(next);
    }
  }
  return reached;
}

std::array<double, 256> cost_factors(double cost_weight) {
  if (!(cost_weight >= 0.0 && cost_weight <= kMaxCostWeight)) {
    throw InputError(fmt::format("cost_weight = {}: must be in [0, {}]", cost_weight, kMaxCostWeight));
  }
  std::array<double, 256> factors{};
  for (std::size_t cost = 0; cost < factors.size(); ++cost) {
    factors[cost] =
        1.0 + cost_weight * std::min<double>(static_cast<double>(cost), kMaxPassableCost) / kMaxPassableCost;
  }
  return factors;
}

Route RoutePlanner::plan(const Grid<Cost>& costs, Cell start, Cell goal) {
  const auto is_blocked = [&](Cell cell) { return !costs.contains(cell) || costs.at(cell) == kLethalCost; };
  Route route;
  if (is_blocked(start)) {
    route.status = PlanStatus::kStartBlocked;
    return route;
  }
  if (is_blocked(goal)) {
    route.status = PlanStatus::kGoalBlocked;
    return route;
  }
  if (start == goal) {
    route.points = {Eigen::Vector2d(start.col + 0.5, start.row + 0.5)};
    route.history = {0.0};
    route.num_iterations = 1;
  } else {
    search(costs, start, goal, route);
  }
  if (route.points.empty()) {
    route.status = is_complete() && !is_step_limit_reached(route) ? PlanStatus::kNoRoute : PlanStatus::kNotFound;
    return route;
  }

  route.status = PlanStatus::kFound;
  route.length = length_of(route.points);
  route.clearance = compute_clearance(costs, route.points);
  route.cost = is_weighted() ? 0.0 : route.length;
  for (std::size_t i = 1; is_weighted() && i < route.points.size(); ++i) {
    route.cost += line_cost(costs, factors_, cell_of(route.points[i - 1]), cell_of(route.points[i])).value();
  }
  return route;
}

}  // namespace patrol::plan
