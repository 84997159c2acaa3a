#include "app/check/scan_reach.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include <fmt/format.h>

#include "core/geometry/angles.h"
#include "importer/robot/scan_plane.h"

namespace patrol::app {
namespace {

double lidar_height_m(const CheckRobot& robot) {
  return robot.expected_height_m + robot.description.T_body("lidar").position.z();
}

}  // namespace

double scan_reach_m(const CheckRobot& robot) {
  const bool has_lidar = std::ranges::find(robot.lidars, "lidar", &CheckLidar::frame) != robot.lidars.end();
  if (!has_lidar) return std::numeric_limits<double>::infinity();
  const double margin_m = lidar_height_m(robot) - robot.scan_leveling.min_height_m;
  if (margin_m <= 0.0) return 0.0;
  const double slope_rad = robot.scan_leveling.tilt_margin_rad;
  return slope_rad > 0.0 ? margin_m / slope_rad : std::numeric_limits<double>::infinity();
}

std::vector<std::string> scan_reach_warnings(const CheckRobot& robot) {
  constexpr double kMinReach_m = 4.0;
  const double reach_m = scan_reach_m(robot);
  if (reach_m >= kMinReach_m) return {};
  return {fmt::format(
      "lidar is {:.2f} m above the ground, stack.scan_leveling.min_height_m is {:.2f} m: the built-in stack ignores "
      "hits farther than {:.1f} m, and half of that or less if the lidar leans",
      lidar_height_m(robot), robot.scan_leveling.min_height_m, reach_m)};
}

std::vector<std::string> scan_plane_warnings(const CheckRobot& robot) {
  std::vector<std::string> warnings;
  for (const CheckLidar& lidar : robot.lidars) {
    if (lidar.settings.rings > 1) continue;
    const double up = std::abs((robot.description.T_body(lidar.frame).rotation * Eigen::Vector3d::UnitZ()).z());
    const double tilt_deg = to_deg(std::acos(std::min(up, 1.0)));
    if (tilt_deg <= importer::kMaxScanTilt_deg) continue;
    warnings.push_back(
        fmt::format("the scan plane of {} is tilted by {:.0f} degrees: mapping and navigation need a horizontal one",
                    lidar.frame, tilt_deg));
  }
  return warnings;
}

}  // namespace patrol::app
