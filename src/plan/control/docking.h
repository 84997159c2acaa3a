#pragma once

#include <optional>
#include <string>

#include "core/dock_detection.h"
#include "core/messages.h"
#include "core/navigation_goal.h"
#include "core/settings.h"
#include "plan/control/dock_pose_filter.h"
#include "plan/control/docking_settings.h"
#include "plan/control/line_following.h"

namespace patrol::plan {

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

  template <typename Archive>
  void serialize_state(Archive& archive) {
    archive(pose_filter_, phase_, text_, start_, stationary_since_, T_odom_left_, num_attempts_);
  }

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
  Pose2 T_odom_left_;  ///< body pose at the start of undocking
  int num_attempts_ = 0;
};

}  // namespace patrol::plan
