#pragma once

#include <Eigen/Core>

#include <array>
#include <cstdint>
#include <limits>
#include <vector>

#include "core/grid.h"
#include "plan/perception/costmap.h"

namespace patrol::plan {

enum class PlanStatus {
  kFound,
  kStartBlocked,
  kGoalBlocked,
  kNoRoute,    ///< there is none
  kNoneFound,  ///< which proves nothing: the planner is not complete, or had to stop
};

/// A way over a grid, and how it was found. Lengths are in cells, so that grids of any resolution compare.
struct Route {
  PlanStatus status = PlanStatus::kNoRoute;
  std::vector<Eigen::Vector2d> points;       ///< start ... goal, cells from the grid's lower-left corner: (col + 0.5, row + 0.5) is a cell's centre
  double length = 0.0;                       ///< cells; exact but for rounding at its end: straight and diagonal steps are counted
  double cost = 0.0;                         ///< cells, each weighted by the costs of the cells it crosses; the length if the weight is 0
  int num_iterations = 0;                    ///< of ants, particles, episodes; 1 of a search
  std::vector<double> history;               ///< [iteration] cost of the best route so far; infinite until there is one
  std::int64_t num_expanded = 0;             ///< cells looked around from; of a swarm the cells its lines crossed
  double clearance = 0.0;                    ///< cells, from the route to the nearest lethal cell's square; at most kMaxClearance
};

inline constexpr double kMaxClearance = 16.0;  ///< cells

/// The iteration, from 1, from which the best cost stays within `share` of its final value; 0 if no route was found.
int iterations_to_within(const std::vector<double>& history, double share);

/// The cell that holds a route's point; of a corner the one above and to the right.
Cell cell_of(const Eigen::Vector2d& point);

/// In the grid's frame, m.
std::vector<Eigen::Vector2d> to_metres(const GridGeometry& geometry, const std::vector<Eigen::Vector2d>& points);

/// Cells from the polyline to the nearest lethal cell's square, at most `at_most`. The grid's border is no obstacle.
double clearance_of(const Grid<Cost>& costs, const std::vector<Eigen::Vector2d>& points, double at_most = kMaxClearance);

/// By how much a cell of each cost lengthens the way through it: 1 + cost weight * cost / kMaxPassableCost. Throws InputError unless the weight lies in 0 ... 50.
std::array<double, 256> cost_factors(double cost_weight);

/// A step to one of the eight neighbours.
struct GridStep {
  int col, row;
};
inline constexpr std::array<GridStep, 8> kGridSteps = {{{1, 0}, {0, 1}, {-1, 0}, {0, -1}, {1, 1}, {-1, 1}, {-1, -1}, {1, -1}}};
inline constexpr std::size_t kFirstDiagonal = 4;

/// Whether a step stays on the grid and out of lethal cells; a diagonal one needs both cells beside it free (MovingAI's rule).
bool may_step(const Grid<Cost>& costs, Cell from, GridStep step);

/// Every cell that steps lead to from a passable one, itself first; by breadth-first search.
std::vector<Cell> reachable_cells(const Grid<Cost>& costs, Cell start);

/// A global planner from cell to cell: lethal cells are blocked, others may lengthen the way through them. The price of a route is the integral of
/// 1 + cost weight * cost / kMaxPassableCost along it.
///
/// The same planner with the same settings and seed gives the same route, on any number of threads and whatever it planned before.
class RoutePlanner {
 public:
  /// `cost_weight`: a cell at the highest passable cost counts as 1 + this many cells; 0 to 50.
  explicit RoutePlanner(double cost_weight) : factors_(cost_factors(cost_weight)) {}
  virtual ~RoutePlanner() = default;

  /// Whether it finds a route wherever there is one.
  virtual bool is_complete() const = 0;

  /// A planner that goes on improving its route (of ants, particles, episodes) ends with the iteration in which it has taken so many steps from cell to
  /// cell, and gives what it has.
  void limit_steps(std::int64_t max_steps) { max_steps_ = max_steps; }

  Route plan(const Grid<Cost>& costs, Cell start, Cell goal);

 protected:
  /// Fills points, history, num_iterations and num_expanded; no points if it finds no route. Both ends are passable, and differ.
  virtual void search(const Grid<Cost>& costs, Cell start, Cell goal, Route& route) = 0;

  /// By how much a cell of this cost lengthens the way through it.
  const std::array<double, 256>& factors() const { return factors_; }
  bool is_spent(const Route& route) const { return route.num_expanded >= max_steps_; }
  bool is_weighted() const { return factors_[kMaxPassableCost] > 1.0; }

 private:
  std::array<double, 256> factors_;
  std::int64_t max_steps_ = std::numeric_limits<std::int64_t>::max();
};

}  // namespace patrol::plan
