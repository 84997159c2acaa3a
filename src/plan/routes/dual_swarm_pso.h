#pragma once

#include <cstdint>
#include <vector>

#include "core/random.h"
#include "core/settings.h"
#include "plan/routes/route_planner.h"

namespace patrol::plan {

struct DualSwarmPsoSettings {
  int particles = 40;              ///< particles per swarm
  int iterations = 200;            ///< number of iterations
  int via_points = 5;              ///< number of via points of a particle's route, in order
  double exploring_inertia = 0.9;  ///< inertia weight of the exploring swarm
  double refining_inertia = 0.5;   ///< inertia weight of the refining swarm
  double cognitive_weight = 1.5;   ///< cognitive weight c_1: toward the particle's own best
  double social_weight = 1.5;      ///< social weight c_2: toward the swarm's best
  double max_speed = 0.1;          ///< maximum change of a coordinate, as a fraction of the grid's longer side
  int exchange_period = 10;        ///< iterations between exchanges: each swarm's best replaces the other's worst

  template <typename Self, typename Visitor>
  static void fields(Self& self, Visitor& visit) {
    visit("particles", self.particles, between(1, 100000));
    visit("iterations", self.iterations, between(1, 100000));
    visit("via_points", self.via_points, between(1, 200));
    visit("exploring_inertia", self.exploring_inertia, between(0.0, 1.0));
    visit("refining_inertia", self.refining_inertia, between(0.0, 1.0));
    visit("cognitive_weight", self.cognitive_weight, between(0.0, 4.0));
    visit("social_weight", self.social_weight, between(0.0, 4.0));
    visit("max_speed", self.max_speed, between(0.001, 1.0));
    visit("exchange_period", self.exchange_period, between(1, 100000));
  }
};

/// Particle swarm optimization [Kennedy95], [Shi98] with two swarms: the class of the mine rescue robot's planner
/// [Feng20] that [Li22] compares with. Only the two sentences of [Li22] on it are known; from them comes the number of
/// populations.
///
/// The remainder is an interpretation: one swarm explores, the other, with less inertia, refines; they exchange their
/// best. A particle is a list of via points. Its route goes from each to the next by the neighbor nearest to it and
/// backtracks out of dead ends; loops are removed as for ants. So every particle has a route if one exists. With
/// straight legs and a penalty on obstacles instead, fewer than one swarm in ten found a route on generated grids of 50
/// x 50.
class DualSwarmPso : public RoutePlanner {
 public:
  DualSwarmPso(const DualSwarmPsoSettings& settings, double cost_weight, std::uint64_t seed);

  bool is_complete() const override { return true; }

 private:
  void search(const Grid<Cost>& costs, Cell start, Cell goal, Route& route) override;

  DualSwarmPsoSettings settings_;
  RandomStream stream_;
};

}  // namespace patrol::plan
