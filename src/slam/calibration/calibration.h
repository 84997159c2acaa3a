#pragma once

#include <optional>

#include "core/sensors/recorded_scan.h"
#include "core/settings.h"

namespace patrol::slam {

/// What is wrong with a log's odometry and with the place of its lidar. The defaults change nothing.
///
/// A step of odometry from scan to scan, with m its move seen from the middle of its turn (an arc's chord then lies along x), becomes
///
///   move  distance_scale * m      turn  turn_scale * turn + steering_rad_per_m * m_x
///
/// the three numbers of a differential drive whose two radii and track are not what its software takes them for (Censi, Franchi, Marchionni, Oriolo,
/// "Simultaneous calibration of odometry and sensor parameters for mobile robots", IEEE T-RO 29(2), 2013, eq. 1), but for the move that unequal wheels make while
/// turning on the spot: nothing tells it from a lidar that sits elsewhere. The lidar's place is that seen from the point that moves as odometry says; on tracks,
/// which turn about where they grip, that is not quite the body's origin.
struct Calibration {
  bool places_lidar = false;        ///< the lidar sits where the next three say, not where the log has it
  double lidar_x_m = 0.0;           ///< in body
  double lidar_y_m = 0.0;
  double lidar_yaw_rad = 0.0;
  double distance_scale = 1.0;      ///< true way over odometry's
  double turn_scale = 1.0;          ///< true turn over odometry's
  double steering_rad_per_m = 0.0;  ///< turned to the left for each metre ahead that odometry counts, unknown to it

  Pose2 T_body_lidar() const { return {lidar_x_m, lidar_y_m, lidar_yaw_rad}; }
  bool changes_odometry() const { return distance_scale != 1.0 || turn_scale != 1.0 || steering_rad_per_m != 0.0; }

  template <typename Self, typename Visitor>
  static void fields(Self& self, Visitor& visit) {
    visit("places_lidar", self.places_lidar);
    visit("lidar_x_m", self.lidar_x_m, between(-100.0, 100.0));
    visit("lidar_y_m", self.lidar_y_m, between(-100.0, 100.0));
    visit("lidar_yaw_rad", self.lidar_yaw_rad, between(-7.0, 7.0));
    visit("distance_scale", self.distance_scale, between(0.01, 100.0));
    visit("turn_scale", self.turn_scale, between(0.01, 100.0));
    visit("steering_rad_per_m", self.steering_rad_per_m, between(-10.0, 10.0));
  }
};

/// The true step of the body, of one that odometry saw. The step must be less than half a turn.
Pose2 corrected_step(const Pose2& T_before_now, const Calibration& calibration);

/// Puts a calibration over a log's scans as they come, one after the other.
class CalibratedScans {
 public:
  explicit CalibratedScans(const Calibration& calibration) : calibration_(calibration) {}

  /// Odometry goes on from where the first scan has it.
  void correct(RecordedScan& recorded);

 private:
  Calibration calibration_;
  std::optional<Pose2> T_odom_last_;  ///< as recorded
  Pose2 T_corrected_last_;
};

}  // namespace patrol::slam
