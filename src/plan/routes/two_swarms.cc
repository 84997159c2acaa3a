#include "plan/routes/two_swarms.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <utility>

#include "plan/routes/line_of_sight.h"

namespace patrol::plan {
namespace {

constexpr double kInfinite = std::numeric_limits<double>::infinity();
constexpr double kTouched = 0.5;  ///< a lethal cell that is only touched counts as so long a way through it, cells

/// x and y of each via point, cells.
using Coordinates = std::vector<double>;

struct Price {
  double fitness = kInfinite;  ///< the less the better
  bool is_route = false;       ///< no lethal cell is met; the fitness is the route's cost
};

struct Particle {
  Coordinates at, velocity, best_at;
  Price best;
};

struct Swarm {
  double inertia;
  std::vector<Particle> particles;

  std::size_t best() const { return extreme([](double a, double b) { return a < b; }); }
  std::size_t worst() const { return extreme([](double a, double b) { return a > b; }); }

 private:
  template <typename Better>
  std::size_t extreme(Better better) const {
    std::size_t found = 0;
    for (std::size_t i = 1; i < particles.size(); ++i) {
      if (better(particles[i].best.fitness, particles[found].best.fitness)) found = i;
    }
    return found;
  }
};

class Flight {
 public:
  Flight(const TwoSwarmsSettings& settings, const Grid<Cost>& costs, const std::array<double, 256>& factors, Cell start, Cell goal)
      : settings_(settings), costs_(costs), factors_(factors), start_(start), goal_(goal) {}

  /// Its cells, without repetitions.
  std::vector<Cell> legs(const Coordinates& via) const {
    std::vector<Cell> cells{start_};
    for (std::size_t i = 0; i < via.size(); i += 2) {
      const Cell cell{static_cast<int>(via[i]), static_cast<int>(via[i + 1])};
      if (cell != cells.back()) cells.push_back(cell);
    }
    if (goal_ != cells.back()) cells.push_back(goal_);
    return cells;
  }

  Price price(const Coordinates& via, std::int64_t& num_crossed) const {
    const std::vector<Cell> cells = legs(via);
    Price price{.fitness = 0.0, .is_route = true};
    for (std::size_t i = 1; i < cells.size(); ++i) {
      const double length = std::hypot(cells[i].col - cells[i - 1].col, cells[i].row - cells[i - 1].row);
      walk_line(cells[i - 1], cells[i], [&](Cell cell, double share) {
        const bool is_lethal = costs_.at(cell) == kLethalCost;
        price.fitness += is_lethal ? settings_.lethal_price * std::max(kTouched, share * length) : share * length * factors_[costs_.at(cell)];
        price.is_route = price.is_route && !is_lethal;
        ++num_crossed;
        return true;
      });
    }
    return price;
  }

  /// Scattered about the straight line from start to goal, `spread` of the grid's longer side wide.
  Particle make_particle(RandomSequence& random, double spread) const {
    Particle particle;
    for (int i = 0; i < settings_.via_points; ++i) {
      const double along = (i + 1.0) / (settings_.via_points + 1.0);
      particle.at.push_back(keep_x(start_.col + 0.5 + along * (goal_.col - start_.col) + spread * longer_side() * (random.uniform() - 0.5)));
      particle.at.push_back(keep_y(start_.row + 0.5 + along * (goal_.row - start_.row) + spread * longer_side() * (random.uniform() - 0.5)));
    }
    particle.velocity.assign(particle.at.size(), 0.0);
    particle.best_at = particle.at;
    return particle;
  }

  void fly(Particle& particle, double inertia, const Coordinates& swarm_best, RandomSequence& random) const {
    const double fastest = settings_.max_speed * longer_side();
    for (std::size_t i = 0; i < particle.at.size(); ++i) {
      const double own = settings_.own_pull * random.uniform() * (particle.best_at[i] - particle.at[i]);
      const double others = settings_.swarm_pull * random.uniform() * (swarm_best[i] - particle.at[i]);
      particle.velocity[i] = std::clamp(inertia * particle.velocity[i] + own + others, -fastest, fastest);
      particle.at[i] = i % 2 == 0 ? keep_x(particle.at[i] + particle.velocity[i]) : keep_y(particle.at[i] + particle.velocity[i]);
    }
  }

 private:
  double longer_side() const { return std::max(costs_.geometry().width, costs_.geometry().height); }
  double keep_x(double x) const { return std::clamp(x, 0.0, costs_.geometry().width - 0.5); }
  double keep_y(double y) const { return std::clamp(y, 0.0, costs_.geometry().height - 0.5); }

  const TwoSwarmsSettings& settings_;
  const Grid<Cost>& costs_;
  const std::array<double, 256>& factors_;
  Cell start_, goal_;
};

void exchange(Swarm& from, Swarm& to) {
  const Particle& best = from.particles[from.best()];
  Particle& worst = to.particles[to.worst()];
  if (best.best.fitness < worst.best.fitness) worst.at = worst.best_at = best.best_at, worst.best = best.best;
}

}  // namespace

TwoSwarms::TwoSwarms(const TwoSwarmsSettings& settings, double cost_weight, std::uint64_t seed)
    : RoutePlanner(cost_weight), settings_(settings), stream_(seed, "plan/routes/swarms") {
  validate(settings_, "two_swarms");
}

void TwoSwarms::search(const Grid<Cost>& costs, Cell start, Cell goal, Route& route) {
  const Flight flight(settings_, costs, factors(), start, goal);
  Coordinates best_route;
  double best_cost = kInfinite;
  const auto judge = [&](Particle& particle) {
    const Price price = flight.price(particle.at, route.num_expanded);
    if (price.fitness < particle.best.fitness) particle.best = price, particle.best_at = particle.at;
    if (price.is_route && price.fitness < best_cost) best_cost = price.fitness, best_route = particle.at;
  };

  constexpr double kExploringSpread = 1.0, kRefiningSpread = 0.3;
  std::array<Swarm, 2> swarms = {Swarm{.inertia = settings_.exploring_inertia, .particles = {}}, Swarm{.inertia = settings_.refining_inertia, .particles = {}}};
  RandomSequence first(stream_, 0);
  for (Swarm& swarm : swarms) {
    for (int i = 0; i < settings_.particles; ++i) {
      swarm.particles.push_back(flight.make_particle(first, &swarm == &swarms[0] ? kExploringSpread : kRefiningSpread));
      judge(swarm.particles.back());
    }
  }
  for (int iteration = 1; iteration <= settings_.iterations; ++iteration) {
    RandomSequence random(stream_, static_cast<std::uint64_t>(iteration));
    for (Swarm& swarm : swarms) {
      const Coordinates swarm_best = swarm.particles[swarm.best()].best_at;
      for (Particle& particle : swarm.particles) {
        flight.fly(particle, swarm.inertia, swarm_best, random);
        judge(particle);
      }
    }
    if (iteration % settings_.exchange_iterations == 0) {
      exchange(swarms[0], swarms[1]);
      exchange(swarms[1], swarms[0]);
    }
    route.history.push_back(best_cost);
    ++route.num_iterations;
  }
  if (!std::isfinite(best_cost)) return;
  for (const Cell cell : flight.legs(best_route)) route.points.emplace_back(cell.col + 0.5, cell.row + 0.5);
}

}  // namespace patrol::plan
