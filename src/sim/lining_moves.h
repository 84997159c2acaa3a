#pragma once

#include <optional>
#include <string>
#include <vector>

#include <mujoco/mujoco.h>

#include "core/settings.h"
#include "core/tunnel_lining.h"

namespace patrol::sim {

/// How some rings of the lining have moved since they were built, each in the same way. Directions are the clock positions of
/// core/tunnel_lining.h.
///   convergence: all of a ring inwards by `inward_mm`;
///   settlement: its half circle sinks by that, which is inwards by the cosine of the clock position; the walls below stay;
///   bulge: inwards by that at `clock_deg`, falling to nothing at `half_width_deg` to both sides as cos^2 does.
struct LiningMoveSettings {
  std::string kind = "convergence";
  int first_ring = 1;
  int last_ring = 1;
  double inward_mm = 0.0;  ///< negative: outwards
  double clock_deg = 0.0;         ///< of a bulge
  double half_width_deg = 20.0;  ///< of a bulge

  template <typename Self, typename Visitor>
  static void fields(Self& self, Visitor& visit) {
    visit("kind", self.kind, one_of({"convergence", "settlement", "bulge"}));
    visit("first_ring", self.first_ring, at_least(1.0));
    visit("last_ring", self.last_ring, at_least(1.0));
    visit("inward_mm", self.inward_mm, between(-100.0, 100.0));
    visit("clock_deg", self.clock_deg, between(0.0, 360.0));
    visit("half_width_deg", self.half_width_deg, between(1.0, 180.0));
  }
};

/// By how much the intrados of a ring has moved there, towards the half circle's centre. Moves add up.
double inward_m(const std::vector<LiningMoveSettings>& moves, int ring, double clock_deg);

/// Moves the inner face of the mesh of geom `lining`, whose corners stand on both sides of every joint between rings. For a view
/// model that nothing was made of yet: no scene, no picture. Throws InputError naming `lining.<index>.<field>` when a setting breaks
/// its rule, the ring does not exist, or the world has no lining. `design` is in world.
void move_lining(const std::vector<LiningMoveSettings>& moves, const std::optional<TunnelLining>& design, mjModel& view);

}  // namespace patrol::sim
