#pragma once

#include <cstdint>

#include "core/frames.h"
#include "core/geometry/angles.h"
#include "core/random.h"
#include "core/sensors/registry.h"
#include "core/tunnel_lining.h"
#include "inspect/lining/reference.h"
#include "tests/support/lined_tunnel.h"

namespace patrol::test {

/// A station of a lining that was scanned twice.
struct LiningStation {
  TunnelLining design_in_map;
  inspect::LiningReference reference;
  PanoramicScan scan;
  Pose3 T_map_scanner;        ///< ground truth pose of the scan relative to the reference
  Pose3 T_map_scanner_guess;  ///< 0.1 m and 1 degree off, one standard deviation, and 3 cm in height
};

/// The second time the robot stands 0.1 m away, one standard deviation. Compensators leave 0.1 mrad, ranges are offset
/// by 0.5 mm, and the map, in which heights are 0.3 m lower, has the reference 0.1 m and 5 mrad off.
inline LiningStation scan_twice(const LinedTunnel& before, const LinedTunnel& after, double chainage_m, double left_m,
                                std::uint64_t seed, double step_deg) {
  const RandomStream draw(seed, "test/station");
  const auto place = draw.normals(0), turn = draw.normals(1), tilt = draw.normals(2), survey = draw.normals(3),
             guess = draw.normals(4);
  const auto pose = [&](double along_m, double aside_m, double roll, double pitch, double yaw) {
    const Eigen::Vector2d p = before.lining.point_at(chainage_m + along_m, left_m + aside_m);
    return Pose3{{p.x(), p.y(), 0.85},
                 quaternion_from_yaw(before.lining.heading_at(chainage_m + along_m) + yaw) *
                     quaternion_from_rpy(roll, pitch, 0.0)};
  };
  const Pose3 T_route_first = pose(0.0, 0.0, 1e-4 * tilt[0], 1e-4 * tilt[1], 0.02 * turn[0]);
  const Pose3 T_route_second = pose(0.1 * place[0], 0.1 * place[1], 1e-4 * tilt[2], 1e-4 * tilt[3], 0.02 * turn[1]);
  const PanoramicScan first =
      before.scan(T_route_first, {.step_deg = step_deg, .range_offset_m = 5e-4 * place[2]}, 2 * seed);

  LiningStation station;
  const Pose3 T_map_route{{1.0, 2.0, -0.3}, quaternion_from_yaw(0.4)};
  station.design_in_map = before.lining;
  station.design_in_map.T_route_start = to_pose2(T_map_route) * before.lining.T_route_start;
  const Pose3 T_map_first = T_map_route * T_route_first;
  const Pose3 T_map_surveyed{T_map_first.position + Eigen::Vector3d(0.1 * survey[0], 0.1 * survey[1], 0.02),
                             quaternion_from_yaw(0.005 * survey[2]) * T_map_first.rotation};
  station.reference = inspect::make_reference(first, T_map_surveyed);
  station.scan = after.scan(T_route_second, {.step_deg = step_deg, .range_offset_m = 5e-4 * place[3]}, 2 * seed + 1);
  station.T_map_scanner = T_map_surveyed * T_route_first.inverse() * T_route_second;
  station.T_map_scanner_guess =
      remove_tilt({station.T_map_scanner.position + Eigen::Vector3d(0.1 * guess[0], 0.1 * guess[1], 0.03 * guess[2]),
                   quaternion_from_yaw(kDegree * guess[3]) * station.T_map_scanner.rotation});
  return station;
}

}  // namespace patrol::test
