#pragma once

#include <cstdint>
#include <vector>

#include "core/random.h"
#include "core/settings.h"
#include "plan/routes/route_planner.h"

namespace patrol::plan {

struct TwoSwarmsSettings {
  int particles = 40;              ///< in each swarm
  int iterations = 200;
  int via_points = 5;              ///< that a particle's route visits, in order
  double exploring_inertia = 0.9;
  double refining_inertia = 0.5;
  double own_pull = 1.5;           ///< towards the particle's own best, c_1
  double swarm_pull = 1.5;         ///< towards its swarm's best, c_2
  double max_speed = 0.1;          ///< of a coordinate in an iteration, as a share of the grid's longer side
  int exchange_iterations = 10;    ///< as often each swarm's best takes the place of the other's worst

  template <typename Self, typename Visitor>
  static void fields(Self& self, Visitor& visit) {
    visit("particles", self.particles, between(1, 100000));
    visit("iterations", self.iterations, between(1, 100000));
    visit("via_points", self.via_points, between(1, 200));
    visit("exploring_inertia", self.exploring_inertia, between(0.0, 1.0));
    visit("refining_inertia", self.refining_inertia, between(0.0, 1.0));
    visit("own_pull", self.own_pull, between(0.0, 4.0));
    visit("swarm_pull", self.swarm_pull, between(0.0, 4.0));
    visit("max_speed", self.max_speed, between(0.001, 1.0));
    visit("exchange_iterations", self.exchange_iterations, between(1, 100000));
  }
};

/// Particle swarms (Kennedy, Eberhart 1995; inertia of Shi and Eberhart 1998), two of them, as in the mine rescue robot's planner that paper 003 compares
/// with (Feng et al. 2020). That paper is known to us by paper 003's two sentences only; from it comes that there are two populations. The rest is
/// ours: one swarm explores, the other, of less inertia, refines; they exchange their best. A particle is a list of points; its route goes from
/// each to the next by the neighbour that is nearest to it, back out of dead ends, and loops are spliced out, as the ants' are. So every particle
/// has a route if there is one. (Straight legs instead, and a price on obstacles: on generated grids of 50 x 50 hardly one swarm in ten found any.)
class TwoSwarms : public RoutePlanner {
 public:
  TwoSwarms(const TwoSwarmsSettings& settings, double cost_weight, std::uint64_t seed);

  bool is_complete() const override { return true; }

 private:
  void search(const Grid<Cost>& costs, Cell start, Cell goal, Route& route) override;

  TwoSwarmsSettings settings_;
  RandomStream stream_;
};

}  // namespace patrol::plan
