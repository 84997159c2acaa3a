#pragma once

#include "core/navigation_goal.h"
#include "core/settings.h"
#include "plan/control/differential_pose_controller_settings.h"
#include "plan/control/line_following.h"

namespace patrol::plan {

/// Controller for the last meter of a robot on tracks or two wheels: turns toward the goal position, drives there, and
/// turns to the goal heading. The final turn skids and displaces the robot sideways. This error is removed by backing
/// up along the goal's axis and driving in again; further turns in place would skid as much again.
class DifferentialPoseController {
 public:
  explicit DifferentialPoseController(const DifferentialPoseControllerSettings& settings) : settings_(settings) {}

  /// Resets the controller for another goal, or after another controller has driven.
  void reset();
  /// Command of one control period; zero at the goal.
  VelocityCommand step(const Pose2& T_map_body, const NavigationGoal& goal);
  /// Whether the pose is within `tolerance_fraction` of the tolerances, or within the tolerances at the end of a pass.
  bool is_done() const { return phase_ == Phase::kDone; }
  /// Reports that the last command is blocked; the next backing-up maneuver begins at the other end.
  void block();

  template <typename Archive>
  void serialize_state(Archive& archive) {
    archive(phase_, forward_, back_off_side_);
  }

 private:
  enum class Phase { kChoose, kTurnToPosition, kDriveToPosition, kTurnToHeading, kBackOff, kDriveLine, kDone };

  Phase choose(const Pose2& T_goal_body, const NavigationGoal& goal) const;
  VelocityCommand turn_to_position(const Pose2& T_goal_body);
  VelocityCommand drive_to_position(const Pose2& T_goal_body, const NavigationGoal& goal);
  VelocityCommand turn_to_heading(const Pose2& T_goal_body, const NavigationGoal& goal);
  VelocityCommand back_off(const Pose2& T_goal_body, const NavigationGoal& goal);
  VelocityCommand drive_line(const Pose2& T_goal_body, const NavigationGoal& goal);
  double speed_mps(double remaining_m) const;
  double yaw_rate_radps(double turn_rad) const;

  DifferentialPoseControllerSettings settings_;
  Phase phase_ = Phase::kChoose;
  double forward_ = 1.0;         ///< -1 if this leg is driven in reverse
  double back_off_side_ = -1.0;  ///< direction of backing up along the goal's x axis: -1 or 1
};

}  // namespace patrol::plan
