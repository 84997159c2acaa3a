#pragma once

#include <cmath>
#include <cstddef>
#include <vector>

#include <Eigen/Core>

#include "core/frames.h"
#include "core/sensors/lidar.h"
#include "core/trajectory.h"
#include "sim/as_built/sensor_errors.h"

namespace patrol::realism {

/// Returns the nominal direction of an azimuth, in `lidar`.
inline Eigen::Vector3d direction_of(double azimuth_rad) { return {std::cos(azimuth_rad), std::sin(azimuth_rad), 0.0}; }

/// Scan with the pose of its lidar in the site while the beams are fired.
struct PosedScan {
  LaserScan scan;
  /// Poses at equal steps of time from the first to the last beam; one pose if all beams have the same instant.
  std::vector<Pose3> T_site_lidar;
  sim::LidarAim aim{sim::LidarErrors{}};  ///< directions of the beams in the housing; nominal unless they are known

  std::size_t num_beams() const { return scan.ranges_m.size(); }
  /// Returns the azimuth of a beam in `lidar`, rad.
  double azimuth_rad(std::size_t beam) const {
    return scan.angle_min_rad + static_cast<double>(beam) * scan.angle_increment_rad;
  }
  /// Returns the direction of a beam, in `lidar`, by its azimuth.
  Eigen::Vector3d direction_at(double azimuth_rad) const { return aim(direction_of(azimuth_rad)); }
  /// Returns the pose of the lidar at the instant of a beam.
  Pose3 pose_of(std::size_t beam) const;
};

/// Places a scan on a path: every beam has the interpolated pose of its own instant. Returns false, and leaves `posed`
/// unchanged, if the path does not cover the scan. A scan without beam times has one pose.
bool place_scan(const LaserScan& scan, const Trajectory& T_site_body, const Pose3& T_body_lidar, PosedScan& posed);

/// Moves the poses of a scan by a planar correction about the first pose: x, y in site and yaw.
PosedScan corrected(const PosedScan& posed, const Eigen::Vector3d& correction);

}  // namespace patrol::realism
