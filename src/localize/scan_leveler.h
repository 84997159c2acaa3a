#pragma once

#include <functional>
#include <optional>

#include "core/frames.h"
#include "core/messages.h"
#include "core/sensors/registry.h"
#include "localize/legged_odometry.h"
#include "localize/scan_leveler_settings.h"

namespace patrol::localize {

using PoseLookup = std::function<std::optional<Pose3>(Time)>;

/// Motion compensation of a 2D scan. The origin of each beam is the lidar position at the time of this beam. Beam ends
/// are expressed in the level frame at the time of the last beam, so that the result is current.
///
/// A tilted beam is used only within a height band above the ground. Hits below (ground, curb) or above the band are
/// not obstacles; the beam then clears the part within the band.
class ScanLeveler {
 public:
  ScanLeveler(Pose3 T_body_lidar, const ScanLevelerSettings& settings);

  /// Replaces the mounting pose of the lidar, for the following scans.
  void set_lidar_pose(const Pose3& T_body_lidar) { T_body_lidar_ = T_body_lidar; }

  /// Returns the compensated scan; nullopt if the poses do not cover the scan, or if it has no beams.
  std::optional<LevelScan> level(const LaserScan& scan, const LeggedOdometry& odometry) const;
  std::optional<LevelScan> level(const LaserScan& scan, const PoseLookup& T_odom_body_at, double body_height_m) const;

 private:
  /// Beam in level: a point moves from `start` along `direction` (unit length).
  struct Ray {
    Eigen::Vector3d start;
    Eigen::Vector3d direction;
  };
  void add_beam(const Ray& ray, float range_m, double body_height_m, LevelScan& level) const;
  /// Returns the length of the ray within the height band.
  double length_in_band(const Ray& ray, double body_height_m) const;

  Pose3 T_body_lidar_;
  ScanLevelerSettings settings_;
};

}  // namespace patrol::localize
