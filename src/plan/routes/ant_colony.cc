#include "plan/routes/ant_colony.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <thread>
#include <utility>

#include "core/geometry/angles.h"
#include "plan/routes/grid_path.h"

namespace patrol::plan {
namespace {

constexpr double kReach = 1.5 * std::numbers::sqrt2;  // eq. 8: L tan(gamma / 2), cells
constexpr double kToEdge = (kReach - 1.0) / kReach,
                 kToDiagonal = (kReach - std::numbers::sqrt2) / kReach;  // 0.53, 0.33 (eqs. 8, 9)
constexpr double kMinWeight = 1e-200;  ///< positive, because the only open step must remain possible

double octile(Cell a, Cell b) {
  const int dx = std::abs(a.col - b.col), dy = std::abs(a.row - b.row);
  return std::max(dx, dy) + (std::numbers::sqrt2 - 1.0) * std::min(dx, dy);
}

double power(double base, double exponent) { return exponent == 1.0 ? base : std::pow(base, exponent); }

/// tau'' of each step as a fraction of the pheromone of its cell (eqs. 7-9), [cell * 8 + direction]. Empty without
/// diffusion.
std::vector<double> diffusion_fractions(const std::optional<ImprovedColonySettings>& settings, const Grid<Cost>& costs,
                                        Cell goal) {
  std::vector<double> fractions;
  if (!settings) return fractions;
  const Grid<Eigen::Vector2d> forces = potential_forces(settings->field, costs, goal);
  const double min_cosine = std::cos(to_rad(settings->half_angle_deg));
  for (const Eigen::Vector2d& force : forces.values()) {
    const double size = force.norm();
    for (std::size_t direction = 0; direction < 8; ++direction) {
      const Eigen::Vector2d step(kGridSteps[direction].col, kGridSteps[direction].row);
      const bool is_along = size > 0.0 && step.dot(force) >= (min_cosine - 1e-9) * step.norm() * size;
      fractions.push_back(is_along ? settings->coefficient * std::min(1.0, size) *
                                         (direction < kFirstDiagonal ? kToEdge : kToDiagonal)
                                   : 0.0);
    }
  }
  return fractions;
}

/// Pheromone and the constant factors of the step weights.
class Trails {
 public:
  Trails(const AntColonySettings& settings, const std::optional<ImprovedColonySettings>& improved,
         const Grid<Cost>& costs, const StepGraph& graph, Cell goal)
      : settings_(settings),
        graph_(graph),
        fractions_(diffusion_fractions(improved, costs, goal)),
        pheromone_(8 * graph.steps.size(), 1.0),
        weights_(pheromone_.size(), 0.0),
        eta_(graph.steps.size()) {
    for (std::uint32_t cell = 0; cell < eta_.size(); ++cell) {
      const Cell at = graph.cell_of(cell);
      eta_[cell] = std::pow(std::max(0.5, std::hypot(at.col - goal.col, at.row - goal.row)), -settings.beta);
    }
  }

  /// Updates the weights of eq. 10, without its denominator, [cell * 8 + direction].
  const std::vector<double>& update_weights() {
    for (std::uint32_t cell = 0; cell < eta_.size(); ++cell) {
      const std::size_t first = 8 * std::size_t{cell};
      double in_cell = std::numeric_limits<double>::infinity();  // q(i)
      for (std::size_t direction = 0; direction < 8 && !fractions_.empty(); ++direction) {
        if (graph_.has_step(cell, direction)) in_cell = std::min(in_cell, pheromone_[first + direction]);
      }
      for (std::size_t direction = 0; direction < 8; ++direction) {
        if (!graph_.has_step(cell, direction)) continue;
        const double spread = fractions_.empty() ? 0.0 : fractions_[first + direction] * in_cell;
        const double tau = pheromone_[first + direction] + spread;
        weights_[first + direction] =
            std::max(kMinWeight, power(tau, settings_.alpha) * eta_[graph_.next(cell, direction)]);
      }
    }
    return weights_;
  }

  void evaporate() {
    for (double& tau : pheromone_) tau *= 1.0 - settings_.evaporation;  // eq. 11
  }

  /// Deposits pheromone on the steps of a path (eqs. 12, 13).
  void deposit(const GridPath& path, double amount) {
    for (std::size_t i = 0; i < path.cells.size(); ++i)
      pheromone_[8 * std::size_t{path.cells[i]} + path.directions[i]] += amount;
  }

 private:
  const AntColonySettings& settings_;
  const StepGraph& graph_;
  std::vector<double> fractions_, pheromone_, weights_;  ///< [cell * 8 + direction]
  std::vector<double> eta_;                              ///< [cell], to the power of beta
};

/// Samples one of the open steps with probability proportional to its weight (eq. 10).
std::size_t sample_step(const std::vector<double>& weights, std::uint32_t cell, unsigned open, RandomSequence& random) {
  const double* const of_cell = weights.data() + 8 * std::size_t{cell};
  double total = 0.0;
  for (std::size_t direction = 0; direction < 8; ++direction)
    total += (open >> direction & 1u) != 0 ? of_cell[direction] : 0.0;
  double left = total * random.uniform();
  std::size_t sampled = 0;
  for (std::size_t direction = 0; direction < 8 && left >= 0.0; ++direction) {
    if ((open >> direction & 1u) != 0) left -= of_cell[direction], sampled = direction;
  }
  return sampled;
}

/// Calls `work(begin, end, worker)` in parallel for `num_workers` parts of 0 ... count - 1.
template <typename Work>
void in_parallel(int count, int num_workers, const Work& work) {
  std::vector<std::jthread> threads;
  for (int worker = 1; worker < num_workers; ++worker) {
    threads.emplace_back(work, count * worker / num_workers, count * (worker + 1) / num_workers, worker);
  }
  work(0, count / num_workers, 0);
}

}  // namespace

AntColony::AntColony(const AntColonySettings& settings, const std::optional<ImprovedColonySettings>& improved,
                     double cost_weight, std::uint64_t seed)
    : RoutePlanner(cost_weight), settings_(settings), improved_(improved), stream_(seed, "plan/routes/ants") {
  validate(settings_, "ant_colony");
  if (improved_) validate(*improved_, "improved_colony");
}

void AntColony::search(const Grid<Cost>& costs, Cell start, Cell goal, Route& route) {
  const StepGraph graph(costs, factors());
  Trails trails(settings_, improved_, costs, graph, goal);
  const int cores = static_cast<int>(std::max(1u, std::thread::hardware_concurrency()));
  const int num_workers = std::min(settings_.ants, settings_.threads > 0 ? settings_.threads : cores);
  std::vector<GridPathBuilder> path_builders(static_cast<std::size_t>(num_workers), GridPathBuilder(graph));
  std::vector<GridPath> paths(static_cast<std::size_t>(settings_.ants));
  const std::uint32_t from = graph.index_of(start), to = graph.index_of(goal);
  const double Q = settings_.deposit * octile(start, goal);
  GridPath best;
  best.cost = std::numeric_limits<double>::infinity();
  for (int iteration = 0; iteration < settings_.iterations && !is_step_limit_reached(route); ++iteration) {
    const std::vector<double>& weights = trails.update_weights();
    in_parallel(settings_.ants, num_workers, [&](int begin, int end, int worker) {
      GridPathBuilder& path_builder = path_builders[static_cast<std::size_t>(worker)];
      for (int ant = begin; ant < end; ++ant) {
        RandomSequence random(stream_,
                              static_cast<std::uint64_t>(iteration) * static_cast<std::uint64_t>(settings_.ants) +
                                  static_cast<std::uint64_t>(ant));
        GridPath& path = paths[static_cast<std::size_t>(ant)];
        path = path_builder.build(
            from, to, [&](std::uint32_t cell, unsigned open) { return sample_step(weights, cell, open, random); });
        if (settings_.remove_loops) path_builder.remove_loops(path, to);
        if (improved_ && improved_->shorten_paths) {
          path_builder.shorten(path, to);
          path_builder.remove_loops(path, to);
        }
        path.cost = path_cost(graph, path);
      }
    });
    trails.evaporate();
    for (const GridPath& path : paths) {
      route.num_expanded += path.num_steps;
      if (path.cells.empty()) return;  // exhaustive: no route exists
      trails.deposit(path, Q / path.cost);
      if (path.cost < best.cost) best = path;
    }
    trails.deposit(best, settings_.elite * Q / best.cost);
    route.history.push_back(best.cost);
    ++route.num_iterations;
  }
  route.points = to_points(graph, best, goal);
}

}  // namespace patrol::plan
