#include "sim/lining_deformation.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include <Eigen/Geometry>
#include <fmt/format.h>

#include "core/error.h"
#include "core/geometry/angles.h"

namespace patrol::sim {
namespace {

/// Returns the fraction of `inward_mm` that applies at a clock position.
double fraction_at(const LiningDeformationSettings& move, double clock_deg) {
  if (move.kind == "settlement") return std::max(0.0, std::cos(clock_deg * kDegree));
  if (move.kind == "bulge") {
    const double offset_deg = std::abs(std::remainder(clock_deg - move.clock_deg, 360.0));
    return offset_deg < move.half_width_deg
               ? std::pow(std::cos(0.5 * std::numbers::pi * offset_deg / move.half_width_deg), 2.0)
               : 0.0;
  }
  return 1.0;
}

void check(const std::vector<LiningDeformationSettings>& moves, const std::optional<TunnelLining>& design) {
  for (std::size_t i = 0; i < moves.size(); ++i) {
    const LiningDeformationSettings& move = moves[i];
    validate(move, fmt::format("lining_deformation.{}", i));
    const auto refuse = [&](const char* field, int ring, const std::string& why) {
      throw InputError(fmt::format("lining_deformation.{}.{} = {}: {}", i, field, ring, why));
    };
    if (!design) refuse("first_ring", move.first_ring, "requires a lining in the mission file");
    if (move.last_ring < move.first_ring)
      refuse("last_ring", move.last_ring, fmt::format("must be at least first_ring, {}", move.first_ring));
    if (move.last_ring > design->rings)
      refuse("last_ring", move.last_ring,
             fmt::format("must be at most {}, the last ring of the lining", design->rings));
  }
}

/// Tolerance for recognizing vertices of the intrados. The outer face is decimeters farther out.
constexpr double kIntradosTolerance_m = 0.05;

}  // namespace

double inward_m(const std::vector<LiningDeformationSettings>& moves, int ring, double clock_deg) {
  double inward = 0.0;
  for (const LiningDeformationSettings& move : moves) {
    if (ring >= move.first_ring && ring <= move.last_ring)
      inward += 1e-3 * move.inward_mm * fraction_at(move, clock_deg);
  }
  return inward;
}

void deform_lining(const std::vector<LiningDeformationSettings>& moves, const std::optional<TunnelLining>& design,
                   mjModel& view) {
  check(moves, design);
  if (moves.empty()) return;
  const int geom = mj_name2id(&view, mjOBJ_GEOM, "lining");
  if (geom < 0 || view.geom_type[geom] != mjGEOM_MESH || view.geom_bodyid[geom] != 0) {
    throw InputError("lining_deformation.0.first_ring: requires a world with a mesh named lining");
  }
  const mjtNum* q = view.geom_quat + 4 * geom;
  const Pose3 T_world_mesh{Eigen::Vector3d(view.geom_pos + 3 * geom), Eigen::Quaterniond(q[0], q[1], q[2], q[3])};
  const int mesh = view.geom_dataid[geom];
  for (int corner = 0; corner < view.mesh_vertnum[mesh]; ++corner) {
    Eigen::Map<Eigen::Vector3f> in_mesh(view.mesh_vert + 3 * (view.mesh_vertadr[mesh] + corner));
    const Eigen::Vector3d p_world = T_world_mesh * in_mesh.cast<double>();
    const TunnelCoordinates coordinates = design->to_tunnel_coordinates(p_world);
    const double clock_deg = design->clock_deg(coordinates);
    const double radius_m = std::hypot(coordinates.left_m, coordinates.height_m - design->crown_center_m);
    if (std::abs(radius_m - design->radius_at(clock_deg)) > kIntradosTolerance_m) continue;
    const double inward = inward_m(moves, design->ring_at(coordinates.chainage_m), clock_deg);
    if (inward == 0.0) continue;
    const double scale =
        1.0 - inward / radius_m;  // fraction of the distance from the half circle's center that remains
    const Eigen::Vector2d deformed = design->point_at(coordinates.chainage_m, scale * coordinates.left_m);
    const Eigen::Vector3d p_deformed(deformed.x(), deformed.y(),
                                     design->crown_center_m + scale * (coordinates.height_m - design->crown_center_m));
    in_mesh = (T_world_mesh.inverse() * p_deformed).cast<float>();
  }
}

}  // namespace patrol::sim
