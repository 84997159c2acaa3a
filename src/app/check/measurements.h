#pragma once

#include <cstddef>

#include "app/check/circle_fit.h"
#include "app/check/drive_record.h"

/// Measurements on the record of a maneuver.
namespace patrol::app {

/// Load of the motors over a record.
struct MotorMargins {
  double max_torque_ratio = 0.0;   ///< largest torque of a motor relative to its limit
  double mean_torque_ratio = 0.0;  ///< mean over motors and time
  double max_speed_ratio = 0.0;    ///< largest speed of a motor relative to its limit
};
MotorMargins motor_margins(const DriveRecord& record);

/// Returns the largest angle between the z axis of the body and the vertical, deg.
double max_tilt_deg(const DriveRecord& record);

/// Returns the slip of wheels or tracks: 1 - distance over ground / travel, at the end of the record; 0 below 5 cm of
/// travel.
double slip_ratio(const DriveRecord& record);

/// Returns the true over the commanded yaw of the whole record.
double yaw_ratio(const DriveRecord& record);

/// Returns the largest distance of the turn center from its start, m.
double max_center_distance_m(const DriveRecord& record);

/// Returns the circle of the turn center from one fraction of the commanded yaw to another.
Circle driven_circle(const DriveRecord& record, double from, double to);

/// Returns the gauge of a differential drive without slip that turns by the true yaw with the same travels of the
/// sides, relative to `gauge_m`.
double effective_gauge_ratio(const DriveRecord& record, double gauge_m);

/// A stop after the command has fallen to zero.
struct Stop {
  double speed_mps = 0.0;   ///< forward speed when the command fell
  double distance_m = 0.0;  ///< distance over ground until rest
  double duration_s = 0.0;  ///< time until rest
  bool is_at_rest = false;  ///< the robot is at rest at the end of the record
};
/// Rest is a speed below 2 cm/s from then on; of a robot with legs, whose body swings, below 5 cm/s.
Stop measure_stop(const DriveRecord& record, double rest_speed_mps);

}  // namespace patrol::app
