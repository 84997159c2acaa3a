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
  int ants = 80;
  int iterations = 200;
  double alpha = 1.0;         ///< exponent of the pheromone (eq. 10)
  double beta = 7.0;          ///< exponent of 1 / distance to the goal
  double evaporation = 0.1;   ///< share of the pheromone lost in an iteration, rho of eq. 11
  double deposit = 1.0;       ///< Q of eq. 13, in straight-line costs from start to goal; every edge begins with 1
  double elite = 20.0;        ///< ants' worth of pheromone laid on the best route so far; ours
  bool splices = true;        ///< steps between cells of an ant's route that are neighbours replace what lies between; ours
  int threads = 0;            ///< 0: one for each core; changes the time and nothing else

  template <typename Self, typename Visitor>
  static void fields(Self& self, Visitor& visit) {
    visit("ants", self.ants, between(1, 100000));
    visit("iterations", self.iterations, between(1, 100000));
    visit("alpha", self.alpha, between(0.0, 10.0));
    visit("beta", self.beta, between(0.0, 100.0));
    visit("evaporation", self.evaporation, between(0.0, 1.0));
    visit("deposit", self.deposit, between(0.0, 1e6));
    visit("elite", self.elite, between(0.0, 1e6));
    visit("splices", self.splices);
    visit("threads", self.threads, between(0, 256));
  }
};

/// What the improved colony has beside the plain one: paper 003's diffusion of pheromone along the force, and ours.
struct ImprovedColonySettings {
  double coefficient = 4.0;      ///< delta of eqs. 7-9
  double half_angle_deg = 70.0;  ///< neighbours this near to the force's direction get some
  PotentialFieldSettings field = {};
  bool tightens = true;          ///< every ant's route is pulled tight (grid_walk.h) before it counts; ours

  template <typename Self, typename Visitor>
  static void fields(Self& self, Visitor& visit) {
    visit("coefficient", self.coefficient, between(0.0, 100.0));
    visit("half_angle_deg", self.half_angle_deg, between(0.0, 180.0));
    visit("field", self.field);
    visit("tightens", self.tightens);
  }
};

/// Ant system (Dorigo, Maniezzo, Colorni 1996) on the grid, plain or as in paper 003, whose ants also smell pheromone that has spread along the force of
/// an artificial potential field (eqs. 6-13). Pheromone lies on steps from cell to cell.
///
/// Where the paper leaves it open:
///   eq. 10   eta = 1 / d_ij: with d of eq. 6, between neighbours, ants would not know where the goal is. Here, as is usual on grids, d is from the cell
///            stepped into to the goal.
///   eqs. 7-9 q(i), a cell's pheromone, is the least on a step out of it: what is there besides trails. It spreads onto the neighbours in a cone about
///            the force, 0.53 of it to edge neighbours and 0.33 to diagonal ones, times delta and the force's size (at most 1), and adds to
///            the step's own: tau = tau' + tau''. So the force leads the first ants and fades as the trails stand out. (With the sum or the mean of
///            the steps for q, every trail leaks along the force for ever: on grids of rooms such a colony ends longer than the plain one.)
///   eq. 13   L_k, "the longest path of ant k", is the ant's length.
/// Ours, in both colonies: an ant in a dead end goes back step by step, and does not enter a cell twice, so every ant arrives if there is a way; loops
/// are spliced out of its route; the best route so far is laid again by `elite` ants. Ours, in the improved one: every ant's route is pulled tight before
/// it counts, without which ants on large open grids wander about the straight line for hundreds of iterations (`patrol study planners` has both).
class AntColony : public RoutePlanner {
 public:
  /// Plain without `improved`.
  AntColony(const AntColonySettings& settings, const std::optional<ImprovedColonySettings>& improved, double cost_weight, std::uint64_t seed);

  bool is_complete() const override { return true; }

 private:
  void search(const Grid<Cost>& costs, Cell start, Cell goal, Route& route) override;

  AntColonySettings settings_;
  std::optional<ImprovedColonySettings> improved_;
  RandomStream stream_;
};

}  // namespace patrol::plan
