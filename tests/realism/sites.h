#pragma once

#include <cmath>
#include <numbers>
#include <string>
#include <vector>

#include "realism/posed_scan.h"
#include "realism/site.h"
#include "sim/mujoco.h"

namespace patrol::realism::test {

inline constexpr double kPi = std::numbers::pi;

inline Site site_of(const std::string& geoms) {
  const sim::SpecPtr spec =
      sim::parse_spec("<mujoco><default><geom type=\"box\" rgba=\"0.5 0.5 0.5 1\"/></default><worldbody>" + geoms +
                      "</worldbody></mujoco>");
  return Site(sim::compile(*spec, "test site"));
}

inline std::string box(const std::string& position, const std::string& half_size,
                       const std::string& rgba = "0.5 0.5 0.5 1") {
  return "<geom pos=\"" + position + "\" size=\"" + half_size + "\" rgba=\"" + rgba + "\"/>";
}

/// Walls at x = +-4 m and y = +-3 m.
inline std::string room() {
  return box("4.5 0 0", "0.5 4 3") + box("-4.5 0 0", "0.5 4 3") + box("0 3.5 0", "5 0.5 3") +
         box("0 -3.5 0", "5 0.5 3");
}

/// Range in that room from (x, y) along an angle in site.
inline double room_range_m(double angle_rad, double x_m = 0.0, double y_m = 0.0) {
  const double c = std::cos(angle_rad), s = std::sin(angle_rad);
  const double to_x = c > 0.0 ? (4.0 - x_m) / c : c < 0.0 ? (-4.0 - x_m) / c : 1e9;
  const double to_y = s > 0.0 ? (3.0 - y_m) / s : s < 0.0 ? (-3.0 - y_m) / s : 1e9;
  return std::min(to_x, to_y);
}

/// Scan without ranges.
inline PosedScan posed_scan(std::size_t beams, double fov_rad = 2.0 * kPi, Pose2 T_site_lidar = {}) {
  PosedScan posed;
  posed.scan.angle_min_rad = -fov_rad / 2.0;
  posed.scan.angle_increment_rad = fov_rad / static_cast<double>(beams);
  posed.scan.range_min_m = 0.05;
  posed.scan.range_max_m = 30.0;
  posed.scan.ranges_m.assign(beams, 0.0f);
  posed.T_site_lidar = {to_pose3(T_site_lidar)};
  return posed;
}

}  // namespace patrol::realism::test
