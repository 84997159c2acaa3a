#pragma once

#include <cstddef>
#include <vector>

#include "core/frames.h"

namespace patrol::app {

/// State of a check drive by ground truth. Motor values are those of the time since the sample before.
struct DriveSample {
  double time_s = 0.0;  ///< time since the start of the record
  Pose3 T_world_body;
  Pose2 T_start_center;            ///< turn center of the robot relative to its start
  double yaw_rad = 0.0;            ///< yaw relative to the start, unwrapped
  Pose2 T_start_commanded;         ///< integral of the commands
  double commanded_yaw_rad = 0.0;  ///< integral of the commanded yaw rate
  double speed_mps = 0.0;          ///< forward, in body
  double yaw_rate_radps = 0.0;
  double commanded_speed_mps = 0.0;
  double commanded_lateral_mps = 0.0;  ///< commanded lateral speed, positive to the left
  double commanded_yaw_rate_radps = 0.0;
  double ground_travel_m = 0.0;    ///< integral of the forward speed
  double left_travel_m = 0.0;      ///< mean travel of the left wheels or track by their joints and nominal radii
  double right_travel_m = 0.0;     ///< travel of the right wheels or track
  double max_torque_ratio = 0.0;   ///< largest torque of a motor relative to its limit
  double mean_torque_ratio = 0.0;  ///< mean over the motors and the time
  double max_speed_ratio = 0.0;    ///< largest speed of a motor relative to its limit, mean over the time: a
                                   ///< foot that hits the ground turns its motors faster for a moment
  double tilt_rad = 0.0;           ///< largest angle between the z axis of the body and the vertical
};

/// Record of a maneuver from its start, after the robot has settled.
struct DriveRecord {
  std::vector<DriveSample> samples;       ///< every `kSamplePeriod_s`; at least one
  std::vector<std::size_t> segment_ends;  ///< index of the first sample after each segment, its rest included
  double hull_contact_s = 0.0;            ///< time with a contact of the hull
  std::size_t num_hull_contacts = 0;      ///< contacts of parts that are neither wheel, track nor foot with the ground
  double friction = 0.0;                  ///< largest friction coefficient of a contact of wheel, track or foot
  bool has_fallen = false;                ///< according to the firmware
};

inline constexpr double kSamplePeriod_s = 0.02;

}  // namespace patrol::app
