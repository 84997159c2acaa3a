#include "sim/ideal_scan.h"

#include <cmath>
#include <numbers>

#include "core/geometry/angles.h"

namespace patrol::sim {

std::vector<BeamReturn> ideal_scan(const LidarScene& scene, const Eigen::Vector3d& p_world_m,
                                   const IdealScanSettings& settings) {
  const double min_cosine = std::cos(to_rad(settings.max_incidence_deg));
  std::vector<BeamReturn> returns;
  for (int beam = 0; beam < settings.beams; ++beam) {
    const double angle = 2.0 * std::numbers::pi * beam / settings.beams;
    const Eigen::Vector3d direction(std::cos(angle), std::sin(angle), 0.0);
    const std::optional<RayHit> hit = scene.cast(p_world_m, direction, settings.range_max_m, kRayScenery);
    if (!hit || -hit->normal.dot(direction) < min_cosine) continue;
    returns.push_back({.direction = direction.head<2>(), .range_m = hit->distance_m, .normal = hit->normal});
  }
  return returns;
}

}  // namespace patrol::sim
