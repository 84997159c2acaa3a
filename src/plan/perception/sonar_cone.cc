#include "plan/perception/sonar_cone.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace patrol::plan {
namespace {

/// Range from the transducer to the intersection of the cone's lower edge with level ground; infinite without one.
double ground_range_m(double height_m, double elevation_rad, double half_fov_rad) {
  const double down = half_fov_rad - elevation_rad;
  return down > 0.0 ? height_m / std::sin(down) : std::numeric_limits<double>::infinity();
}

/// Appends points at a range over a sector.
void add_arc(const Eigen::Vector2d& center, double azimuth_rad, double half_rad, double range_m, double spacing_m,
             std::vector<Eigen::Vector2d>& points) {
  const int steps = std::max(1, static_cast<int>(std::ceil(2.0 * half_rad * range_m / (spacing_m / 2.0))));
  for (int i = 0; i <= steps; ++i) {
    const double angle = azimuth_rad + half_rad * (2.0 * i / steps - 1.0);
    points.emplace_back(center + range_m * Eigen::Vector2d(std::cos(angle), std::sin(angle)));
  }
}

}  // namespace

SonarCone inverse_sonar_model(const SonarConeSettings& settings, const UltrasonicRange& ping,
                              const Pose3& T_level_transducer, double body_height_m, double spacing_m) {
  SonarCone cone;
  const auto measured = static_cast<double>(ping.range_m);
  if (std::isnan(measured)) return cone;
  const Eigen::Vector3d axis = T_level_transducer.rotation * Eigen::Vector3d::UnitX();
  const double azimuth = std::atan2(axis.y(), axis.x()), elevation = std::asin(std::clamp(axis.z(), -1.0, 1.0));
  const Eigen::Vector2d center = T_level_transducer.position.head<2>();
  const double half_fov = ping.field_of_view_rad / 2.0;
  const double range_m = std::max(measured, ping.range_min_m);
  const double ground_m = ground_range_m(body_height_m + T_level_transducer.position.z(), elevation, half_fov);

  const bool may_be_ground = range_m > settings.ground_range_fraction * ground_m;
  if (range_m <= settings.max_range_m && !may_be_ground) {
    add_arc(center, azimuth, settings.fov_fraction * half_fov, range_m, spacing_m, cone.arc_m);
  }
  const double free_to_m = std::min(range_m, settings.max_range_m) - spacing_m;
  for (double r = spacing_m / 2.0; r < free_to_m; r += spacing_m / 2.0) {
    add_arc(center, azimuth, settings.fov_fraction * half_fov, r, spacing_m, cone.free_m);
  }
  return cone;
}

}  // namespace patrol::plan
