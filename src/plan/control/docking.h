#pragma once

#include <optional>
#include <string>

#include "core/dock_detection.h"
#include "core/messages.h"
#include "core/navigation_goal.h"
#include "core/settings.h"
#include "plan/control/dock_pose_filter.h"
#include "plan/control/line_following.h"

namespace patrol::plan {

struct DockingSettings {
  double staging_distance_m = 1.35;         ///< distance of the staging pose, straight before the docked pose
  double staging_tolerance_m = 0.1;      ///< tolerances of the navigator at the staging pose
  double staging_tolerance_rad = 0.1;
  double max_speed_mps = 0.2;
  double min_speed_mps = 0.03;
  double speed_gain_per_s = 0.5;   ///< speed per meter of remaining distance
  double min_yaw_rate_radps = 0.06;
  double corridor_half_width_m = 0.02;          ///< half-width of the approach corridor at the docked pose
  double corridor_slope = 0.3;     ///< widening per meter before it; outside, the robot backs up and retries
  double heading_blend_distance_m = 0.15;  ///< final distance over which the heading blends into the dock's heading
  double position_tolerance_m = 0.012;   ///< position tolerance of the docked pose, by the robot's own estimate
  double yaw_tolerance_rad = 0.008;
  double settling_time_s = 1.0;           ///< stationary time before the docked pose is checked
  int min_detections = 5;           ///< minimum number of detections before the robot moves
  double max_detection_gap_s = 1.0;        ///< maximum age of the last detection; the robot stops beyond
  double detection_timeout_s = 10.0;   ///< time without a detection after which docking fails
  int max_attempts = 4;
  double timeout_s = 120.0;
  double undock_distance_m = 1.2;           ///< distance driven straight back
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

enum class DockingStatus { kIdle, kDocking, kDocked, kUndocking, kFree, kFailed };

struct DockingStep {
  VelocityCommand command;
  DockingStatus status = DockingStatus::kIdle;
  std::string text;  ///< one sentence in the step in which the state changes; else empty
};

/// Drives a tracked robot from the staging pose to the charging post, and away from it. It uses only detections of the
/// post, fused in `odom`: the pose in the map is not accurate enough.
///
/// Sequence: detect the post, turn to the line, drive in with a lateral error that falls with the distance, align with
/// the dock, stop and measure again. Outside of the corridor the robot backs up and retries, at most `max_attempts`
/// times, then docking fails.
class Docking {
 public:
  /// Throws InputError if a setting breaks its rule.
  explicit Docking(const DockingSettings& settings);

  /// Goal of the navigator before `dock`.
  NavigationGoal staging_goal(const Pose2& T_map_docked) const;

  void dock(Time now);
  /// Leaves the dock from the current pose; no detection of the post is needed.
  void undock(Time now, const Pose2& T_odom_body);
  void stop();

  /// Fuses a detection. `T_odom_body` is the pose at its stamp. Ignored unless docking.
  void add(const DockDetection& detection, const Pose2& T_odom_body);
  /// Docked pose in the body's gravity-aligned frame, for the detector's next scan; none before the first detection.
  std::optional<Pose2> T_level_docked(const Pose2& T_odom_body) const;

  /// Command and status of one control period.
  DockingStep step(Time now, const Pose2& T_odom_body);

  DockingStatus status() const;

 private:
  enum class Phase { kIdle, kDetect, kTurn, kDriveIn, kCheck, kCorrect, kBackUp, kDocked, kUndock, kFree, kFailed };

  VelocityCommand turn_to_line(const Pose2& T_docked_body);
  VelocityCommand drive_in(Time now, const Pose2& T_docked_body);
  void check_docked(Time now, const Pose2& T_docked_body);
  VelocityCommand correct(Time now, const Pose2& T_docked_body);
  VelocityCommand back_up(const Pose2& T_docked_body);
  VelocityCommand drive_out(const Pose2& T_odom_body);
  void retry();
  void enter(Phase phase, const char* text);
  double yaw_rate_radps(double turn_rad) const;

  DockingSettings settings_;
  DockPoseFilter pose_filter_;
  Phase phase_ = Phase::kIdle;
  std::string text_;
  Time start_{};
  Time stationary_since_{};
  Pose2 T_odom_left_;    ///< body pose at the start of undocking
  int num_attempts_ = 0;
};

}  // namespace patrol::plan
