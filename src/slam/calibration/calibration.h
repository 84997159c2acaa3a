#pragma once

#include <optional>

#include "core/sensors/recorded_scan.h"
#include "core/settings.h"

namespace patrol::slam {

/// Calibration of the odometry and lidar pose of a log. The defaults leave the log unchanged.
///
/// For an odometry increment from scan to scan, m is its translation in the frame of its mean heading, so that the
/// chord of an arc lies along x. The increment becomes
///
///   translation  distance_scale * m      rotation  rotation_scale * yaw_change + steering_bias_rad_per_m * m_x
///
/// These are the three parameters of a differential drive with wrong wheel radii and wheel base [Censi13, eq. 1].
/// Deviation from [Censi13]: the translation of unequal wheels during a turn in place is omitted. It cannot be
/// distinguished from a different lidar position. The lidar pose is relative to the point that moves as odometry
/// reports. On a tracked vehicle, which turns about its instantaneous center of rotation, that point differs slightly
/// from the body origin.
struct Calibration {
  bool override_lidar_pose = false;  ///< use of the following lidar pose in place of that of the log
  double lidar_x_m = 0.0;            ///< lidar pose in body
  double lidar_y_m = 0.0;
  double lidar_yaw_rad = 0.0;
  double distance_scale = 1.0;           ///< true distance / odometry distance
  double rotation_scale = 1.0;           ///< true yaw change / odometry yaw change
  double steering_bias_rad_per_m = 0.0;  ///< unmeasured yaw change to the left per meter of odometry

  Pose2 T_body_lidar() const { return {lidar_x_m, lidar_y_m, lidar_yaw_rad}; }
  bool changes_odometry() const {
    return distance_scale != 1.0 || rotation_scale != 1.0 || steering_bias_rad_per_m != 0.0;
  }

  template <typename Self, typename Visitor>
  static void fields(Self& self, Visitor& visit) {
    visit("override_lidar_pose", self.override_lidar_pose);
    visit("lidar_x_m", self.lidar_x_m, between(-100.0, 100.0));
    visit("lidar_y_m", self.lidar_y_m, between(-100.0, 100.0));
    visit("lidar_yaw_rad", self.lidar_yaw_rad, between(-7.0, 7.0));
    visit("distance_scale", self.distance_scale, between(0.01, 100.0));
    visit("rotation_scale", self.rotation_scale, between(0.01, 100.0));
    visit("steering_bias_rad_per_m", self.steering_bias_rad_per_m, between(-10.0, 10.0));
  }
};

/// Returns the corrected increment of the body for an odometry increment of less than half a turn.
Pose2 corrected_step(const Pose2& T_before_now, const Calibration& calibration);

/// Applies a calibration to the scans of a log in sequence.
class CalibratedScans {
 public:
  explicit CalibratedScans(const Calibration& calibration) : calibration_(calibration) {}

  /// Corrects a scan in place. The corrected odometry starts at that of the first scan.
  void correct(RecordedScan& recorded);

 private:
  Calibration calibration_;
  std::optional<Pose2> T_odom_last_;  ///< odometry of the last scan as recorded
  Pose2 T_corrected_last_;
};

}  // namespace patrol::slam
