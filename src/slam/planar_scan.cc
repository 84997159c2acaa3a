#include "slam/planar_scan.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "slam/range_smoothing.h"
#include "slam/rigid_motion.h"

namespace patrol::slam {
LevelScan planar_scan(const RecordedScan& recorded, const PlanarScanSettings& settings) {
  const LaserScan& scan = recorded.scan;
  const std::vector<float> ranges_m =
      settings.range_std_m > 0.0 ? smoothed_ranges(scan, settings.range_std_m) : scan.ranges_m;
  LevelScan level;
  level.stamp = scan.stamp;
  level.origin_m = recorded.T_body_lidar.position();
  const double last_beam = std::max(1.0, static_cast<double>(ranges_m.size()) - 1.0);
  for (std::size_t beam = 0; beam < ranges_m.size(); ++beam) {
    const double range = ranges_m[beam];
    if (std::isnan(range) || range < settings.min_range_m) continue;
    const bool is_hit = range <= settings.max_range_m;
    const double length = is_hit              ? range
                          : std::isinf(range) ? settings.no_return_clearing_range_m
                                              : settings.max_range_m;
    if (!(length > 0.0)) continue;
    const double angle = scan.angle_min_rad + static_cast<double>(beam) * scan.angle_increment_rad;
    const Pose2 T_body_then = scaled_motion(recorded.T_begin_end, static_cast<double>(beam) / last_beam);
    const Eigen::Vector2d end =
        T_body_then * (recorded.T_body_lidar * Eigen::Vector2d(length * std::cos(angle), length * std::sin(angle)));
    level.beams.push_back({end.cast<float>(), is_hit});
  }
  return level;
}

}  // namespace patrol::slam
