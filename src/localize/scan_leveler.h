#pragma once

#include <functional>
#include <optional>

#include "core/frames.h"
#include "core/messages.h"
#include "core/sensors/registry.h"
#include "core/settings.h"
#include "localize/body_estimator.h"

namespace patrol::localize {

struct ScanLevelerSettings {
  /// Height limits of obstacles above the ground under the feet; a curb of 0.12 m is lower.
  double min_height_m = 0.15;
  double max_height_m = 1.5;
  double tilt_margin_rad =
      0.008;  ///< margin for an apparent rise of the ground with distance: tilt error and slope
  double self_filter_radius_m = 0.32;  ///< hits closer to the vertical axis of the body are the robot itself
  double no_return_clearing_range_m =
      6.0;  ///< a beam without return clears this distance only: glass and black surfaces give no return
  double max_range_m = 30.0;  ///< hits farther away are excluded
  bool gimbal_stabilized = false;    ///< the lidar is on a stabilized gimbal: scans are level although the body tilts

  template <typename Self, typename Visitor>
  static void fields(Self& self, Visitor& visit) {
    visit("min_height_m", self.min_height_m, between(-1.0, 5.0));
    visit("max_height_m", self.max_height_m, between(0.0, 20.0));
    visit("tilt_margin_rad", self.tilt_margin_rad, between(0.0, 0.2));
    visit("self_filter_radius_m", self.self_filter_radius_m, between(0.0, 2.0));
    visit("no_return_clearing_range_m", self.no_return_clearing_range_m, between(0.0, 100.0));
    visit("max_range_m", self.max_range_m, between(0.1, 400.0));
    visit("gimbal_stabilized", self.gimbal_stabilized);
  }
};

using PoseLookup = std::function<std::optional<Pose3>(Time)>;

/// Motion compensation of a 2D scan. The origin of each beam is the lidar position at the time of this beam. Beam ends
/// are expressed in the level frame at the time of the last beam, so that the result is current.
///
/// A tilted beam is used only within a height band above the ground. Hits below (ground, curb) or above the band are
/// not obstacles; the beam then clears the part within the band.
class ScanLeveler {
 public:
  ScanLeveler(const Pose3& T_body_lidar, const ScanLevelerSettings& settings);

  /// Returns the compensated scan; nullopt if the poses do not cover the scan, or if it has no beams.
  std::optional<LevelScan> level(const LaserScan& scan, const BodyEstimator& odometry) const;
  std::optional<LevelScan> level(const LaserScan& scan, const PoseLookup& T_odom_body_at,
                                 double body_height_m) const;

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
