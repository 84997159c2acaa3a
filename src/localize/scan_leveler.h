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
  double min_height_m = 0.15;  ///< of an obstacle, above the ground under the feet; a kerb's 0.12 m is lower
  double max_height_m = 1.5;
  double tilt_margin_rad =
      0.008;  ///< how much the ground may seem to rise with distance: error of the tilt, and slope
  double self_radius_m = 0.32;  ///< hits nearer to the body's vertical axis are the robot itself
  double no_return_free_m =
      6.0;  ///< a beam that meets nothing is believed free so far (glass and black give none either)
  double max_range_m = 30.0;  ///< hits farther away are left out
  bool stabilized = false;    ///< the lidar is held level by a gimbal: the body's tilt is not the scan's

  template <typename Self, typename Visitor>
  static void fields(Self& self, Visitor& visit) {
    visit("min_height_m", self.min_height_m, between(-1.0, 5.0));
    visit("max_height_m", self.max_height_m, between(0.0, 20.0));
    visit("tilt_margin_rad", self.tilt_margin_rad, between(0.0, 0.2));
    visit("self_radius_m", self.self_radius_m, between(0.0, 2.0));
    visit("no_return_free_m", self.no_return_free_m, between(0.0, 100.0));
    visit("max_range_m", self.max_range_m, between(0.1, 400.0));
    visit("stabilized", self.stabilized);
  }
};

using PoseLookup = std::function<std::optional<Pose3>(Time)>;

/// Frees a 2D scan of the robot's motion: each beam is put where the lidar was at that beam's own instant,
/// and its end is expressed in the level frame at the last beam's instant (the newest, so that the result is
/// current).
///
/// A tilted beam is believed only inside a band of heights above the ground: what it hits below (the ground,
/// a kerb) or above is no obstacle, and the beam is known free as far as it stays within the band.
class ScanLeveler {
 public:
  ScanLeveler(const Pose3& T_body_lidar, const ScanLevelerSettings& settings);

  /// None if the poses do not cover the whole scan, or the scan has no beams.
  std::optional<LevelScan> level(const LaserScan& scan, const BodyEstimator& odometry) const;
  std::optional<LevelScan> level(const LaserScan& scan, const PoseLookup& T_odom_body_at,
                                 double body_height_m) const;

 private:
  /// A beam in level: a point moves from `start` along `direction` (unit length).
  struct Ray {
    Eigen::Vector3d start;
    Eigen::Vector3d direction;
  };
  void add_beam(const Ray& ray, float range_m, double body_height_m, LevelScan& level) const;
  /// How far along the ray the height stays within the band.
  double length_in_band(const Ray& ray, double body_height_m) const;

  Pose3 T_body_lidar_;
  ScanLevelerSettings settings_;
};

}  // namespace patrol::localize
