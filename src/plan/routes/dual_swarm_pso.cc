#include "plan/routes/dual_swarm_pso.h"

#include <algorithm>
#include <array>
#include <limits>
#include <utility>

#include "plan/routes/grid_path.h"

namespace patrol::plan {
namespace {

constexpr double kNoCost = std::numeric_limits<double>::infinity();
/// Coordinates x and y of each via point, cells.
using Coordinates = std::vector<double>;

struct Particle {
  Coordinates at, velocity, best_at;
  double best_cost = kNoCost;
};

struct Swarm {
  double inertia;
  std::vector<Particle> particles;

  std::size_t best() const {
    return extreme([](double a, double b) { return a < b; });
  }
  std::size_t worst() const {
    return extreme([](double a, double b) { return a > b; });
  }

 private:
  template <typename Better>
  std::size_t extreme(Better better) const {
    std::size_t found = 0;
    for (std::size_t i = 1; i < particles.size(); ++i) {
      if (better(particles[i].best_cost, particles[found].best_cost)) found = i;
    }
    return found;
  }
};

/// For every cell, the nearest cell reachable from the start, in the chessboard metric across lethal cells.
std::vector<std::uint32_t> nearest_reachable(const StepGraph& graph, const GridGeometry& geometry,
                                             std::uint32_t start) {
  constexpr std::uint32_t kNone = std::numeric_limits<std::uint32_t>::max();
  std::vector<std::uint32_t> nearest(graph.steps.size(), kNone), reached{start};
  nearest[start] = start;
  for (std::size_t i = 0; i < reached.size(); ++i) {
    for (std::size_t direction = 0; direction < 8; ++direction) {
      if (!graph.has_step(reached[i], direction)) continue;
      const std::uint32_t next = graph.next(reached[i], direction);
      if (nearest[next] == kNone) nearest[next] = next, reached.push_back(next);
    }
  }
  for (std::size_t i = 0; i < reached.size(); ++i) {
    const Cell cell = graph.cell_of(reached[i]);
    for (const GridStep step : kGridSteps) {
      const Cell other{cell.col + step.col, cell.row + step.row};
      if (!geometry.contains(other) || nearest[graph.index_of(other)] != kNone) continue;
      nearest[graph.index_of(other)] = nearest[reached[i]];
      reached.push_back(graph.index_of(other));
    }
  }
  return nearest;
}

class Flight {
 public:
  Flight(const DualSwarmPsoSettings& settings, const Grid<Cost>& costs, const std::array<double, 256>& factors,
         Cell start, Cell goal)
      : settings_(settings),
        geometry_(costs.geometry()),
        start_(start),
        goal_(goal),
        graph_(costs, factors),
        path_builder_(graph_),
        nearest_(nearest_reachable(graph_, geometry_, graph_.index_of(start))) {}

  const StepGraph& graph() const { return graph_; }
  bool has_path() const { return nearest_[graph_.index_of(goal_)] == graph_.index_of(goal_); }

  /// Route of a particle at these coordinates.
  GridPath decode(const Coordinates& via) {
    GridPath route;
    std::uint32_t here = graph_.index_of(start_);
    for (std::size_t i = 0; i <= via.size(); i += 2) {
      const Cell at = i < via.size() ? Cell{static_cast<int>(via[i]), static_cast<int>(via[i + 1])} : goal_;
      const std::uint32_t target = nearest_[graph_.index_of(at)];
      const GridPath leg = path_builder_.build(
          here, target, [&](std::uint32_t cell, unsigned open) { return step_toward(target, cell, open); });
      route.cells.insert(route.cells.end(), leg.cells.begin(), leg.cells.end());
      route.directions.insert(route.directions.end(), leg.directions.begin(), leg.directions.end());
      route.num_steps += leg.num_steps;
      here = target;
    }
    path_builder_.remove_loops(route, here);
    route.cost = path_cost(graph_, route);
    return route;
  }

  /// Creates a particle scattered about the straight line from start to goal; `spread` is relative to the grid's longer
  /// side.
  Particle make_particle(RandomSequence& random, double spread) const {
    Particle particle;
    for (int i = 0; i < settings_.via_points; ++i) {
      const double along = (i + 1.0) / (settings_.via_points + 1.0);
      particle.at.push_back(keep_x(start_.col + 0.5 + along * (goal_.col - start_.col) +
                                   spread * longer_side() * (random.uniform() - 0.5)));
      particle.at.push_back(keep_y(start_.row + 0.5 + along * (goal_.row - start_.row) +
                                   spread * longer_side() * (random.uniform() - 0.5)));
    }
    particle.velocity.assign(particle.at.size(), 0.0);
    particle.best_at = particle.at;
    return particle;
  }

  void fly(Particle& particle, double inertia, const Coordinates& swarm_best, RandomSequence& random) const {
    const double max_speed = settings_.max_speed * longer_side();
    for (std::size_t i = 0; i < particle.at.size(); ++i) {
      const double own = settings_.cognitive_weight * random.uniform() * (particle.best_at[i] - particle.at[i]);
      const double others = settings_.social_weight * random.uniform() * (swarm_best[i] - particle.at[i]);
      particle.velocity[i] = std::clamp(inertia * particle.velocity[i] + own + others, -max_speed, max_speed);
      particle.at[i] =
          i % 2 == 0 ? keep_x(particle.at[i] + particle.velocity[i]) : keep_y(particle.at[i] + particle.velocity[i]);
    }
  }

 private:
  std::size_t step_toward(std::uint32_t target, std::uint32_t cell, unsigned open) const {
    const Cell to = graph_.cell_of(target);
    std::size_t nearest = 0;
    int min_squared = std::numeric_limits<int>::max();  // squared distance, cells
    for (std::size_t direction = 0; direction < 8; ++direction) {
      if ((open >> direction & 1u) == 0) continue;
      const Cell next = graph_.cell_of(graph_.next(cell, direction));
      const int squared = (to.col - next.col) * (to.col - next.col) + (to.row - next.row) * (to.row - next.row);
      if (squared < min_squared) min_squared = squared, nearest = direction;
    }
    return nearest;
  }

  double longer_side() const { return std::max(geometry_.width, geometry_.height); }
  double keep_x(double x) const { return std::clamp(x, 0.0, geometry_.width - 0.5); }
  double keep_y(double y) const { return std::clamp(y, 0.0, geometry_.height - 0.5); }

  const DualSwarmPsoSettings& settings_;
  GridGeometry geometry_;
  Cell start_, goal_;
  StepGraph graph_;
  GridPathBuilder path_builder_;
  std::vector<std::uint32_t> nearest_;  ///< [cell]
};

void exchange(Swarm& from, Swarm& to) {
  const Particle& best = from.particles[from.best()];
  Particle& worst = to.particles[to.worst()];
  if (best.best_cost < worst.best_cost) worst.at = worst.best_at = best.best_at, worst.best_cost = best.best_cost;
}

}  // namespace

DualSwarmPso::DualSwarmPso(const DualSwarmPsoSettings& settings, double cost_weight, std::uint64_t seed)
    : RoutePlanner(cost_weight), settings_(settings), stream_(seed, "plan/routes/swarms") {
  validate(settings_, "dual_swarm_pso");
}

void DualSwarmPso::search(const Grid<Cost>& costs, Cell start, Cell goal, Route& route) {
  Flight flight(settings_, costs, factors(), start, goal);
  if (!flight.has_path()) return;
  GridPath best;
  best.cost = kNoCost;
  const auto evaluate = [&](Particle& particle) {
    GridPath path = flight.decode(particle.at);
    route.num_expanded += path.num_steps;
    if (path.cost < particle.best_cost) particle.best_cost = path.cost, particle.best_at = particle.at;
    if (path.cost < best.cost) best = std::move(path);
  };

  constexpr double kExploringSpread = 1.0, kRefiningSpread = 0.3;
  std::array<Swarm, 2> swarms = {Swarm{.inertia = settings_.exploring_inertia, .particles = {}},
                                 Swarm{.inertia = settings_.refining_inertia, .particles = {}}};
  RandomSequence first(stream_, 0);
  for (Swarm& swarm : swarms) {
    for (int i = 0; i < settings_.particles; ++i) {
      swarm.particles.push_back(
          flight.make_particle(first, &swarm == swarms.data() ? kExploringSpread : kRefiningSpread));
      evaluate(swarm.particles.back());
    }
  }
  for (int iteration = 1; iteration <= settings_.iterations && !is_step_limit_reached(route); ++iteration) {
    RandomSequence random(stream_, static_cast<std::uint64_t>(iteration));
    for (Swarm& swarm : swarms) {
      const Coordinates swarm_best = swarm.particles[swarm.best()].best_at;
      for (Particle& particle : swarm.particles) {
        flight.fly(particle, swarm.inertia, swarm_best, random);
        evaluate(particle);
      }
    }
    if (iteration % settings_.exchange_period == 0) {
      exchange(swarms[0], swarms[1]);
      exchange(swarms[1], swarms[0]);
    }
    route.history.push_back(best.cost);
    ++route.num_iterations;
  }
  route.points = to_points(flight.graph(), best, goal);
}

}  // namespace patrol::plan
