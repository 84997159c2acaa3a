#include "plan/routes/q_learning.h"

#include <limits>
#include <optional>
#include <utility>

#include "plan/routes/grid_path.h"

namespace patrol::plan {
namespace {

constexpr double kNever = -std::numeric_limits<double>::infinity();

/// Values of steps, [cell * 8 + direction]: expected return, in cells, all negative.
class QTable {
 public:
  QTable(const StepGraph& graph, std::uint32_t goal)
      : graph_(graph), goal_(goal), values_(8 * graph.steps.size(), 0.0) {
    for (std::uint32_t cell = 0; cell < graph.steps.size(); ++cell) {
      for (std::size_t direction = 0; direction < 8; ++direction) {
        if (!graph.has_step(cell, direction)) values_[8 * std::size_t{cell} + direction] = kNever;
      }
    }
  }

  double& at(std::uint32_t cell, std::size_t direction) { return values_[8 * std::size_t{cell} + direction]; }

  std::size_t best_step(std::uint32_t cell) const {
    const double* const values = values_.data() + 8 * std::size_t{cell};
    std::size_t best = 0;
    for (std::size_t direction = 1; direction < 8; ++direction) {
      if (values[direction] > values[best]) best = direction;
    }
    return best;
  }

  /// Value of a cell; zero at the goal.
  double value(std::uint32_t cell) const {
    return cell == goal_ ? 0.0 : values_[8 * std::size_t{cell} + best_step(cell)];
  }

  /// Path along the best steps; none if they form a loop.
  std::optional<GridPath> follow(std::uint32_t start) const {
    std::vector<std::uint8_t> is_visited(graph_.steps.size(), 0);
    GridPath path;
    for (std::uint32_t here = start; here != goal_;) {
      if (is_visited[here] != 0) return std::nullopt;
      is_visited[here] = 1;
      const std::size_t direction = best_step(here);
      path.cells.push_back(here);
      path.directions.push_back(static_cast<std::uint8_t>(direction));
      path.cost += graph_.step_cost(here, direction);
      here = graph_.next(here, direction);
    }
    return path;
  }

 private:
  const StepGraph& graph_;
  std::uint32_t goal_;
  std::vector<double> values_;
};

/// Samples one of a cell's open steps uniformly.
std::size_t any_step(const StepGraph& graph, std::uint32_t cell, RandomSequence& random) {
  for (;;) {
    const std::size_t direction = random.index(8);
    if (graph.has_step(cell, direction)) return direction;
  }
}

}  // namespace

QLearning::QLearning(const QLearningSettings& settings, double cost_weight, std::uint64_t seed)
    : RoutePlanner(cost_weight), settings_(settings), stream_(seed, "plan/routes/q_learning") {
  validate(settings_, "q_learning");
}

void QLearning::search(const Grid<Cost>& costs, Cell start, Cell goal, Route& route) {
  const StepGraph graph(costs, factors());
  const std::uint32_t from = graph.index_of(start), to = graph.index_of(goal);
  if (graph.steps[from] == 0) return;  // no step out of the start
  QTable table(graph, to);
  const auto max_steps =
      static_cast<std::int64_t>(settings_.max_steps_per_cell * static_cast<double>(graph.steps.size()));
  GridPath best;
  best.cost = std::numeric_limits<double>::infinity();
  for (int episode = 0; episode < settings_.episodes && !is_step_limit_reached(route); ++episode) {
    const double epsilon = settings_.exploration * (1.0 - static_cast<double>(episode) / settings_.episodes);
    RandomSequence random(stream_, static_cast<std::uint64_t>(episode));
    std::uint32_t here = from;
    for (std::int64_t step = 0; step < max_steps && here != to; ++step, ++route.num_expanded) {
      const std::size_t direction = random.uniform() < epsilon ? any_step(graph, here, random) : table.best_step(here);
      const std::uint32_t next = graph.next(here, direction);
      double& value = table.at(here, direction);
      value +=
          settings_.learning_rate * (settings_.discount * table.value(next) - graph.step_cost(here, direction) - value);
      here = next;
    }
    if (std::optional<GridPath> path = table.follow(from); path && path->cost < best.cost) best = std::move(*path);
    route.history.push_back(best.cost);
    ++route.num_iterations;
  }
  if (!best.cells.empty()) route.points = to_points(graph, best, goal);
}

}  // namespace patrol::plan
