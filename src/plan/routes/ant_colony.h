#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "core/random.h"
#include "core/settings.h"
#include "plan/routes/potential_field.h"
#include "plan/routes/route_planner.h"

namespace patrol::plan {

struct AntColonySettings {
  int ants = 80;             ///< number of ants per iteration
  int iterations = 200;      ///< number of iterations
  double alpha = 1.0;        ///< exponent of the pheromone [Li22, eq. 10]
  double beta = 7.0;         ///< exponent of 1 / distance to the goal
  double evaporation = 0.1;  ///< fraction of the pheromone lost in an iteration, rho of eq. 11
  double deposit = 1.0;      ///< Q of eq. 13, relative to the straight-line cost; pheromone starts at 1
  double elite = 20.0;       ///< pheromone of the best route found until then, in ants per iteration; extension
  bool remove_loops = true;  ///< whether steps between neighboring cells of a route replace detours; extension
  int threads = 0;           ///< number of threads; 0: one per core; no influence on the result

  template <typename Self, typename Visitor>
  static void fields(Self& self, Visitor& visit) {
    visit("ants", self.ants, between(1, 100000));
    visit("iterations", self.iterations, between(1, 100000));
    visit("alpha", self.alpha, between(0.0, 10.0));
    visit("beta", self.beta, between(0.0, 100.0));
    visit("evaporation", self.evaporation, between(0.0, 1.0));
    visit("deposit", self.deposit, between(0.0, 1e6));
    visit("elite", self.elite, between(0.0, 1e6));
    visit("remove_loops", self.remove_loops);
    visit("threads", self.threads, between(0, 256));
  }
};

/// Settings of the improved colony beyond the ant system: diffusion of pheromone along the force [Li22] and extensions.
struct ImprovedColonySettings {
  double coefficient = 4.0;      ///< delta of [Li22, eqs. 7-9]
  double half_angle_deg = 70.0;  ///< half-angle about the force's direction in which neighbors receive pheromone
  PotentialFieldSettings field = {};
  bool shorten_paths = true;  ///< whether every ant's route is shortened (grid_path.h) before evaluation; extension

  template <typename Self, typename Visitor>
  static void fields(Self& self, Visitor& visit) {
    visit("coefficient", self.coefficient, between(0.0, 100.0));
    visit("half_angle_deg", self.half_angle_deg, between(0.0, 180.0));
    visit("field", self.field);
    visit("shorten_paths", self.shorten_paths);
  }
};

/// Ant system [Dorigo96] on the grid, plain or improved as in [Li22]. In the improved colony, pheromone also spreads
/// along the force of an artificial potential field (eqs. 6-13). Pheromone belongs to steps from cell to cell.
///
/// Interpretations of [Li22]:
///   eq. 10   eta = 1 / d_ij: with d of eq. 6, between neighbors, ants would have no information on the goal. Here, as
///            is usual on grids, d is the distance from the next cell to the goal.
///   eqs. 7-9 q(i), the pheromone of a cell, is the minimum over the steps out of it: the pheromone besides trails. It
///            spreads to the neighbors in a cone about the force, 0.53 to edge neighbors and 0.33 to diagonal ones,
///            times delta and the force's magnitude (at most 1), and adds to the step's own: tau = tau' + tau''. So the
///            force guides the first ants and fades as the trails grow. With the sum or the mean over the steps for q,
///            each trail spreads along the force without end: on grids of rooms the plain colony is better.
///   eq. 13   L_k, "the longest path of ant k", is the length of the ant's route.
/// Extensions in both colonies: an ant in a dead end backtracks, and does not enter a cell twice, so that every ant
/// arrives if a route exists; loops are removed from its route; `elite` ants deposit pheromone on the best route so
/// far. Extension of the improved colony: every ant's route is shortened before evaluation. Without it, ants on large
/// open grids meander about the straight line for hundreds of iterations (`patrol study planners` compares both).
class AntColony : public RoutePlanner {
 public:
  /// Constructs the plain colony without `improved`.
  AntColony(const AntColonySettings& settings, const std::optional<ImprovedColonySettings>& improved,
            double cost_weight, std::uint64_t seed);

  bool is_complete() const override { return true; }

 private:
  void search(const Grid<Cost>& costs, Cell start, Cell goal, Route& route) override;

  AntColonySettings settings_;
  std::optional<ImprovedColonySettings> improved_;
  RandomStream stream_;
};

}  // namespace patrol::plan
