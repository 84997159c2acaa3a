#pragma once

#include <optional>
#include <string>
#include <vector>

#include <mujoco/mujoco.h>

#include "core/settings.h"
#include "core/tunnel_lining.h"

namespace patrol::sim {

/// Deformation of a range of lining rings since construction, equal for all rings of the range. Directions are the
/// clock positions of core/tunnel_lining.h.
///
/// - convergence: the whole ring moves inward by `inward_mm`.
/// - settlement: the half circle moves down by `inward_mm`, which is inward by the cosine of the clock position; the
/// walls below stay.
/// - bulge: moves inward by `inward_mm` at `clock_deg`, decreasing as cos^2 to zero at `half_width_deg` on both sides.
struct LiningDeformationSettings {
  std::string kind = "convergence";  ///< shape of the displacement: convergence of whole rings, or a bulge
  int first_ring = 1;                ///< number of the first displaced ring
  int last_ring = 1;                 ///< number of the last displaced ring
  double inward_mm = 0.0;            ///< displacement toward the tunnel axis; negative: outward
  double clock_deg = 0.0;            ///< clock position of the center of a bulge; 0: crown
  double half_width_deg = 20.0;      ///< half width of a bulge

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

/// Returns the displacement of a ring's intrados at `clock_deg`, toward the center of the half circle. Deformations add
/// up.
double inward_m(const std::vector<LiningDeformationSettings>& moves, int ring, double clock_deg);

/// Deforms the inner face of the mesh of geom `lining`, whose vertices are on both sides of every joint between rings.
///
/// Precondition: no scene and no renderer has been made of `view`. `design` is in world. Throws InputError naming
/// `lining_deformation.<index>.<field>` when a setting is out of range, the ring does not exist, or the world has no
/// lining.
void deform_lining(const std::vector<LiningDeformationSettings>& moves, const std::optional<TunnelLining>& design,
                   mjModel& view);

}  // namespace patrol::sim
