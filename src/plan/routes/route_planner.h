#pragma once

#include <array>
#include <cstdint>
#include <limits>
#include <vector>

#include <Eigen/Core>

#include "core/grid.h"
#include "plan/perception/costmap.h"

namespace patrol::plan {

enum class PlanStatus {
  kFound,
  kStartBlocked,
  kGoalBlocked,
  kNoRoute,   ///< no route exists
  kNotFound,  ///< no route found; one may exist, because the planner is incomplete or was stopped
};

/// Route over a grid with statistics of its search. Lengths are in cells, so that grids of any resolution are
/// comparable.
struct Route {
  PlanStatus status = PlanStatus::kNoRoute;
  std::vector<Eigen::Vector2d> points;  ///< start ... goal, cells from the lower-left corner; cell centers at .5
  double length = 0.0;                  ///< cells; straight and diagonal steps are counted exactly
  double cost = 0.0;                    ///< cells, weighted by the costs of the cells crossed
  int num_iterations = 0;               ///< iterations of ants, particles or episodes; 1 for a search
  std::vector<double> history;    ///< [iteration], cost of the best route found until then; infinite before the first
  std::int64_t num_expanded = 0;  ///< expanded cells; for a swarm, steps taken
  double clearance = 0.0;         ///< distance to the nearest lethal cell, cells; at most kMaxClearance
};

inline constexpr double kMaxClearance = 16.0;  ///< cells

/// Iteration, counted from 1, from which the best cost is within the fraction `tolerance` of its final value; 0 without
/// a route.
int iterations_to_convergence(const std::vector<double>& history, double tolerance);

/// Cell that contains a point of a route; for a corner, the cell above and to the right.
Cell cell_of(const Eigen::Vector2d& point);

/// Converts points from cells to the grid's frame, m.
std::vector<Eigen::Vector2d> to_meters(const GridGeometry& geometry, const std::vector<Eigen::Vector2d>& points);

/// Distance from the polyline to the nearest lethal cell's square, cells, at most `at_most`. The grid's border is no
/// obstacle.
double compute_clearance(const Grid<Cost>& costs, const std::vector<Eigen::Vector2d>& points,
                         double at_most = kMaxClearance);

/// Cost factors by cell cost: 1 + cost weight * cost / kMaxPassableCost. Throws InputError unless the weight is in [0,
/// 50].
std::array<double, 256> cost_factors(double cost_weight);

/// Step to one of the eight neighbors.
struct GridStep {
  int col, row;
};
inline constexpr std::array<GridStep, 8> kGridSteps = {
    {{1, 0}, {0, 1}, {-1, 0}, {0, -1}, {1, 1}, {-1, 1}, {-1, -1}, {1, -1}}};
inline constexpr std::size_t kFirstDiagonal = 4;

/// Whether a step stays on the grid and outside of lethal cells. A diagonal step needs both adjacent cells free, as in
/// the MovingAI benchmarks [Sturtevant12].
bool is_valid_step(const Grid<Cost>& costs, Cell from, GridStep step);

/// Cells reachable from a passable one by breadth-first search, `start` first.
std::vector<Cell> reachable_cells(const Grid<Cost>& costs, Cell start);

/// Interface of a global planner from cell to cell. Lethal cells are blocked; other costs may increase the cost of a
/// route, which is the integral of 1 + cost weight * cost / kMaxPassableCost along it.
///
/// Equal planners with equal settings and seeds give equal routes, for any number of threads and any earlier calls.
class RoutePlanner {
 public:
  /// `cost_weight`: a cell at the highest passable cost counts as 1 + this number of cells; in [0, 50].
  explicit RoutePlanner(double cost_weight) : factors_(cost_factors(cost_weight)) {}
  virtual ~RoutePlanner() = default;

  /// Whether it finds a route whenever one exists.
  virtual bool is_complete() const = 0;

  /// Limits the steps from cell to cell of an iterative planner (ants, particles, episodes). It ends with the iteration
  /// that exceeds the limit, and returns its best route found until then.
  void limit_steps(std::int64_t max_steps) { max_steps_ = max_steps; }

  Route plan(const Grid<Cost>& costs, Cell start, Cell goal);

 protected:
  /// Fills points, history, num_iterations and num_expanded; no points if it finds no route. Both ends are passable and
  /// different.
  virtual void search(const Grid<Cost>& costs, Cell start, Cell goal, Route& route) = 0;

  /// Cost factors by cell cost (`cost_factors`).
  const std::array<double, 256>& factors() const { return factors_; }
  bool is_step_limit_reached(const Route& route) const { return route.num_expanded >= max_steps_; }
  bool is_weighted() const { return factors_[kMaxPassableCost] > 1.0; }

 private:
  std::array<double, 256> factors_;
  std::int64_t max_steps_ = std::numeric_limits<std::int64_t>::max();
};

}  // namespace patrol::plan
