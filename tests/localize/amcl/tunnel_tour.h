#pragma once

#include <cstdint>

#include <Eigen/Geometry>

#include "core/frames.h"
#include "core/geometry/angles.h"
#include "localize/amcl/monte_carlo.h"
#include "tests/support/tunnel_world.h"

namespace patrol::localize {

inline const Pose3 kAntenna{{-0.2, 0.1, 0.3}, Eigen::Quaterniond::Identity()};
inline const Eigen::Matrix3d kNearly = Eigen::Vector3d(0.01, 0.01, 0.0025).asDiagonal();  // 10 cm, 3 degrees

/// A tunnel, a robot in it and its localizer; two meters a second, so that the tests are short.
struct Tour {
  explicit Tour(std::uint64_t seed, const Pose2& T_map_start, const MonteCarloSettings& settings = {},
                double way_scale_error = 0.02, double speed_mps = 2.0)
      : localizer(settings, test::tunnel_map(), tunnel.anchors(), kAntenna, seed),
        drive(tunnel.world, tunnel.anchors(), kAntenna, T_map_start,
              {.speed_mps = speed_mps, .way_scale_error = way_scale_error}, seed) {}

  LocalizationUpdate step(bool with_ranges) {
    drive.step();
    return look(with_ranges);
  }
  LocalizationUpdate look(bool with_ranges) { return look(with_ranges, tunnel.world); }
  LocalizationUpdate look(bool with_ranges, const test::RoomWorld& world) {
    if (with_ranges) {
      for (const UwbRange& range : drive.ranges()) localizer.add(range, to_pose3(drive.T_odom_body()));
    }
    return localizer.update(drive.scan_of(world), drive.T_odom_body());
  }
  Eigen::Vector3d error(const LocalizationUpdate& update) const {
    Eigen::Vector3d error = update.estimate.T_map_body.vector() - drive.T_map_body().vector();
    error.z() = wrap_angle(error.z());
    return error;
  }
  double error_m(const LocalizationUpdate& update) const { return error(update).head<2>().norm(); }

  test::Tunnel tunnel;
  MonteCarloLocalizer localizer;
  test::TunnelDrive drive;
};

}  // namespace patrol::localize
