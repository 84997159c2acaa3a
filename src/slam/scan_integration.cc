#include "slam/scan_integration.h"

#include <algorithm>

#include "core/point_transform.h"

namespace patrol::slam {

void integrate_scan(const LevelScan& scan, const Pose2& T_map_body, const ScanIntegrationSettings& settings,
                    GridMap& map) {
  const PointTransform to_map(T_map_body);
  const Eigen::Vector2d origin = to_map(scan.origin_m);
  const auto stride = static_cast<std::size_t>(settings.free_ray_stride);
  for (std::size_t beam = 0; beam < scan.beams.size(); beam += stride) {
    const Eigen::Vector2d ray = to_map(scan.beams[beam].end_m.cast<double>()) - origin;
    const double range_m = ray.norm();
    const double margin_m = scan.beams[beam].is_hit ? settings.free_margin_m : 0.0;
    const double free_m = std::min(range_m - margin_m, settings.max_free_range_m);
    if (!(free_m > 0.0)) continue;
    map.add_free_ray(origin, origin + (free_m / range_m) * ray, settings.free_ray_stride, !scan.beams[beam].is_hit);
  }
  for (const LevelScan::Beam& beam : scan.beams) {
    if (beam.is_hit) map.add_hit(to_map(beam.end_m.cast<double>()));
  }
}

}  // namespace patrol::slam
