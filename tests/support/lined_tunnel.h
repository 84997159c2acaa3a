#pragma once

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <string>
#include <vector>

#include <Eigen/Core>
#include <Eigen/Geometry>

#include "core/frames.h"
#include "core/geometry/angles.h"
#include "core/random.h"
#include "core/sensors/registry.h"
#include "core/tunnel_lining.h"

namespace patrol::test {

/// A lined tunnel for a panoramic scanner, in the route's frame with z = 0 at the invert: the analytic lining, whose
/// rings can be moved, level ground, walls across it at both ends, and boxes that stand along the tunnel.
struct LinedTunnel {
  struct Box {
    Eigen::Vector3d low, high;  ///< along x of the tunnel at chainage 0
  };

  TunnelLining lining{.T_route_start = {},
                      .axis = {{80.0, 0.0}, {90.0, 1.0 / 400.0}},
                      .crown_radius_m = 5.5,
                      .crown_center_m = 2.5,
                      .side_radius_m = 8.0,
                      .first_ring_m = 0.0,
                      .ring_length_m = 2.0,
                      .rings = 50};
  std::vector<Box> boxes;
  double begin_m = -30.0, end_m = 160.0;  ///< ends of the tunnel, closed by walls
  std::function<double(int ring, double clock_deg)> inward_m = [](int, double) { return 0.0; };

  /// Boxes beside the wall as they stand in a tunnel: cabinets every 10 m on the right, signs every 14 m on the left, a
  /// lamp every 8 m under the crown; none of them at equal distances.
  LinedTunnel& furnish() {
    for (int i = 0; i < 16; ++i) {
      const double s = 4.0 + 10.0 * i + 1.3 * std::sin(2.1 * i), t = 2.0 + 14.0 * i + 1.7 * std::sin(1.3 * i),
                   u = 8.0 * i + 0.9 * std::sin(i);
      boxes.push_back({{s, -5.1, 0.3}, {s + 0.6, -4.7, 1.8}});
      boxes.push_back({{t, 4.9, 2.5}, {t + 0.1, 5.4, 3.1}});
      boxes.push_back({{u, -0.1, 7.6}, {u + 1.2, 0.1, 7.75}});
    }
    return *this;
  }
  LinedTunnel& park_truck(double chainage_m, double left_m) {
    boxes.push_back({{chainage_m, left_m - 1.25, 0.5}, {chainage_m + 7.0, left_m + 1.25, 2.9}});
    return *this;
  }

  /// Distance from a point along a unit direction; infinity without a surface within 60 m.
  double range_m(const Eigen::Vector3d& from, const Eigen::Vector3d& towards) const {
    double range = 60.0;
    const auto take = [&](double t) {
      if (t > 1e-6) range = std::min(range, t);
    };
    if (towards.z() < 0.0) take(-from.z() / towards.z());
    if (towards.x() != 0.0) take(((towards.x() > 0.0 ? end_m : begin_m) - from.x()) / towards.x());
    for (const Box& box : boxes) {
      const Eigen::Array3d a = (box.low - from).array() / towards.array(),
                           b = (box.high - from).array() / towards.array();
      const double in = a.min(b).maxCoeff(), out = a.max(b).minCoeff();
      if (in < out) take(in);
    }
    range = lining_range_m(from, towards, range);
    return range < 60.0 ? range : std::numeric_limits<double>::infinity();
  }

  struct ScanOptions {
    double step_deg = 0.5;
    double lowest_deg = -60.0;  ///< elevation
    double range_std_m = 0.0015;
    double angle_std_rad = 1e-4;
    double range_offset_m = 0.0;
    double end_m = 35.0;
  };

  /// Scan in `scanner_level`; a pose that is not level is the compensator's error.
  PanoramicScan scan(const Pose3& T_route_scanner, const ScanOptions& options, std::uint64_t seed) const {
    const RandomStream noise(seed, "test/scanner");
    PanoramicScan scan;
    std::uint64_t beam = 0;
    for (double azimuth = 0.0; azimuth < 360.0; azimuth += options.step_deg) {
      for (double elevation = options.lowest_deg; elevation <= 90.0; elevation += options.step_deg) {
        const auto draw = noise.normals(0, beam++);
        const double a = azimuth * kDegree, e = elevation * kDegree;
        const Eigen::Vector3d ray = ray_to(a + options.angle_std_rad * draw[1], e + options.angle_std_rad * draw[2]);
        const double range = range_m(T_route_scanner.position, T_route_scanner.rotation * ray);
        if (!(range < options.end_m)) continue;
        const Eigen::Vector3f p =
            ((range + options.range_offset_m + options.range_std_m * draw[0]) * ray_to(a, e)).cast<float>();
        scan.points.push_back({p.x(), p.y(), p.z(), 100.0F});
      }
    }
    return scan;
  }

 private:
  static Eigen::Vector3d ray_to(double azimuth_rad, double elevation_rad) {
    return {std::cos(elevation_rad) * std::cos(azimuth_rad), std::cos(elevation_rad) * std::sin(azimuth_rad),
            std::sin(elevation_rad)};
  }

  /// Radial distance from a point to the lining, positive inside of it.
  double inside_m(const Eigen::Vector3d& p) const {
    const TunnelCoordinates place = lining.to_tunnel_coordinates(p);
    const double clock_deg = lining.clock_deg(place);
    return lining.radius_at(clock_deg) - inward_m(lining.ring_at(place.chainage_m), clock_deg) -
           std::hypot(place.left_m, place.height_m - lining.crown_center_m);
  }
  /// Range of the lining, by steps of about the distance to the wall, then by secants (Illinois rule).
  double lining_range_m(const Eigen::Vector3d& from, const Eigen::Vector3d& towards, double limit_m) const {
    double t = 0.0, before = 0.0, inside = inside_m(from), inside_before = inside;
    for (; t < limit_m && inside >= 1e-5; inside = inside_m(from + t * towards)) {
      before = t;
      inside_before = inside;
      t += std::max(0.95 * inside, 2e-4);
    }
    if (t >= limit_m) return limit_m;
    for (int side = 0; inside < 0.0 && t - before > 1e-6;) {
      const double ratio = std::clamp(inside_before / (inside_before - inside), 0.01, 0.99);
      const double middle = before + ratio * (t - before), inside_middle = inside_m(from + middle * towards);
      if (std::abs(inside_middle) < 1e-9) return middle;
      if (inside_middle > 0.0) {
        if (side > 0) inside *= 0.5;
        before = middle, inside_before = inside_middle, side = 1;
      } else {
        if (side < 0) inside_before *= 0.5;
        t = middle, inside = inside_middle, side = -1;
      }
    }
    return t;
  }
};

}  // namespace patrol::test
