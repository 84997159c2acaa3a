#pragma once

#include "core/settings.h"
#include "plan/control/dock_pose_filter_settings.h"
#include "plan/control/line_following_settings.h"

namespace patrol::plan {

struct DockingSettings {
  double staging_distance_m = 1.35;     ///< distance of the staging pose from the docked pose
  double staging_tolerance_m = 0.1;     ///< maximum position error at the staging pose
  double staging_tolerance_rad = 0.1;   ///< maximum heading error at the staging pose
  double max_speed_mps = 0.2;           ///< maximum speed of the approach
  double min_speed_mps = 0.03;          ///< minimum speed of the approach
  double speed_gain_per_s = 0.5;        ///< gain from the remaining distance to the speed
  double min_yaw_rate_radps = 0.06;     ///< minimum yaw rate of a turn in place
  double corridor_half_width_m = 0.02;  ///< half width of the approach corridor at the docked pose
  double corridor_slope = 0.3;          ///< increase of the corridor's half width per distance from the docked pose
  /// Distance over which the heading changes from the line to the docked heading.
  double heading_blend_distance_m = 0.15;
  double position_tolerance_m = 0.012;  ///< maximum position error of the docked robot
  double yaw_tolerance_rad = 0.008;     ///< maximum yaw error of the docked robot
  double settling_time_s = 1.0;         ///< time at a standstill after which the pose is compared with the tolerances
  int min_detections = 5;               ///< minimum number of detections of the post before the approach
  double max_detection_gap_s = 1.0;     ///< time without a detection after which the robot stops and waits
  double detection_timeout_s = 10.0;    ///< time without a detection after which docking fails
  int max_attempts = 4;                 ///< maximum number of attempts
  double timeout_s = 120.0;             ///< maximum duration of docking, all attempts together, and of undocking
  double undock_distance_m = 1.2;       ///< distance that the robot backs away from the post
  LineFollowingSettings line;
  DockPoseFilterSettings pose_filter;

  template <typename Self, typename Visitor>
  static void fields(Self& self, Visitor& visit) {
    visit("staging_distance_m", self.staging_distance_m, between(0.3, 5.0));
    visit("staging_tolerance_m", self.staging_tolerance_m, between(0.01, 1.0));
    visit("staging_tolerance_rad", self.staging_tolerance_rad, between(0.01, 1.0));
    visit("max_speed_mps", self.max_speed_mps, between(0.02, 1.0));
    visit("min_speed_mps", self.min_speed_mps, between(0.005, 0.2));
    visit("speed_gain_per_s", self.speed_gain_per_s, between(0.05, 5.0));
    visit("min_yaw_rate_radps", self.min_yaw_rate_radps, between(0.005, 1.0));
    visit("corridor_half_width_m", self.corridor_half_width_m, between(0.005, 0.5));
    visit("corridor_slope", self.corridor_slope, between(0.0, 2.0));
    visit("heading_blend_distance_m", self.heading_blend_distance_m, between(0.0, 1.0));
    visit("position_tolerance_m", self.position_tolerance_m, between(0.002, 0.1));
    visit("yaw_tolerance_rad", self.yaw_tolerance_rad, between(0.001, 0.1));
    visit("settling_time_s", self.settling_time_s, between(0.1, 10.0));
    visit("min_detections", self.min_detections, between(1, 100));
    visit("max_detection_gap_s", self.max_detection_gap_s, between(0.1, 10.0));
    visit("detection_timeout_s", self.detection_timeout_s, between(0.5, 600.0));
    visit("max_attempts", self.max_attempts, between(1, 100));
    visit("timeout_s", self.timeout_s, between(5.0, 3600.0));
    visit("undock_distance_m", self.undock_distance_m, between(0.1, 5.0));
    visit("line", self.line);
    visit("pose_filter", self.pose_filter);
  }
};

}  // namespace patrol::plan
