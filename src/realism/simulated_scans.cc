#include "realism/simulated_scans.h"

#include <algorithm>
#include <cmath>
#include <memory>
#include <numbers>
#include <optional>
#include <tuple>
#include <utility>

#include <fmt/format.h>

#include "core/error.h"
#include "core/geometry/angles.h"
#include "sim/sensors/lidar.h"

namespace patrol::realism {
namespace {

/// Part of a scan that the settings of the lidar model depend on.
using ScanShape = std::tuple<std::size_t, double, double, double, double>;

ScanShape shape_of(const LaserScan& scan) {
  return {scan.ranges_m.size(), scan.angle_min_rad, scan.angle_increment_rad, scan.range_min_m, scan.range_max_m};
}

/// The model fires counterclockwise and symmetric about its x axis; this is the pose of that frame in `lidar`.
Pose3 frame_of_model(const LaserScan& scan, double fov_rad) {
  const double sign = scan.angle_increment_rad < 0.0 ? -1.0 : 1.0;
  const Pose3 turned{Eigen::Vector3d::Zero(), quaternion_from_yaw(scan.angle_min_rad + sign * fov_rad / 2.0)};
  const Pose3 over{Eigen::Vector3d::Zero(), quaternion_from_rpy(sign < 0.0 ? std::numbers::pi : 0.0, 0.0, 0.0)};
  return turned * over;
}

LidarSettings settings_of(const LidarDevice& device, const LaserScan& scan, double fov_rad) {
  LidarSettings settings = device.settings;
  settings.enabled = true;
  settings.rate_hz = 1.0;  // of the model's clock; the instants of the beams come with their poses
  settings.beams = static_cast<int>(scan.ranges_m.size());
  settings.rings = 1;
  settings.fov_deg = std::min(360.0, to_deg(fov_rad));
  settings.elevation_min_deg = settings.elevation_max_deg = 0.0;
  settings.range_min_m = scan.range_min_m;
  settings.range_max_m = std::min(settings.range_max_m, scan.range_max_m);
  settings.motion_distortion = true;
  settings.stabilized = false;
  return settings;
}

/// Fires the beams of one revolution of the model from the poses of a scan.
void fire(sim::Lidar& lidar, std::int64_t revolution, const PosedScan& posed, double fov_rad) {
  const Time begin = from_seconds(static_cast<double>(revolution));
  const double used = std::min(360.0, to_deg(fov_rad)) / 360.0;
  const double first_s = 1.0 - used + used / static_cast<double>(posed.num_beams());
  Time from = begin;
  Time to = begin + from_seconds(first_s);
  lidar.advance(from, to, posed.T_site_lidar.front(), posed.T_site_lidar.front());
  const std::size_t last = posed.T_site_lidar.size() - 1;
  for (std::size_t knot = 1; knot <= last; ++knot) {
    from = std::exchange(
        to, begin + from_seconds(first_s + (1.0 - first_s) * static_cast<double>(knot) / static_cast<double>(last)));
    lidar.advance(from, to, posed.T_site_lidar[knot - 1], posed.T_site_lidar[knot]);
  }
  const Time end = begin + from_seconds(1.0);
  if (to < end) lidar.advance(to, end, posed.T_site_lidar.back(), posed.T_site_lidar.back());
}

}  // namespace

std::vector<std::vector<float>> simulate_scans(const Site& site, const LidarDevice& device,
                                               const std::vector<PosedScan>& scans, std::uint64_t seed) {
  std::vector<std::vector<float>> simulated;
  std::unique_ptr<sim::Lidar> lidar;
  std::optional<ScanShape> shape;
  std::int64_t revolution = 0;
  std::uint64_t num_shapes = 0;
  for (const PosedScan& posed : scans) {
    const double fov_rad = std::abs(posed.scan.angle_increment_rad) * static_cast<double>(posed.num_beams());
    if (!lidar || shape != shape_of(posed.scan)) {
      const double fov_deg = to_deg(fov_rad);
      if (fov_deg < 1.0 || fov_deg > 360.01)
        throw InputError(fmt::format("scan of {:.1f} degrees: must be in [1, 360] for a simulation", fov_deg));
      shape = shape_of(posed.scan);
      lidar = std::make_unique<sim::Lidar>(settings_of(device, posed.scan, fov_rad), site.scene(),
                                           frame_of_model(posed.scan, fov_rad), sim::RayMask{}, seed + num_shapes++,
                                           "realism", sim::DustSettings{}, device.errors);
      revolution = 0;
    }
    fire(*lidar, revolution++, posed, fov_rad);
    simulated.push_back(std::move(lidar->take_scans().at(0).ranges_m));
  }
  return simulated;
}

}  // namespace patrol::realism
