#pragma once

#include "core/navigation_goal.h"
#include "core/settings.h"
#include "plan/control/line_following.h"

namespace patrol::plan {

struct DifferentialPoseControllerSettings {
  double speed_gain_per_s = 1.0;    ///< speed per meter of remaining distance
  double max_speed_mps = 0.3;
  double min_speed_mps = 0.04;      ///< minimum speed that the tracks follow smoothly
  double min_yaw_rate_radps = 0.08; ///< minimum yaw rate that the tracks follow smoothly
  double tolerance_fraction = 0.5;           ///< fraction of the goal's tolerances that a pass aims at
  double max_reverse_distance_m = 1.0;  ///< maximum distance of a goal behind the robot that is approached in reverse
  double lateral_correction_distance_m = 0.25;  ///< distance below which lateral errors are corrected by backing up
  double max_back_off_m = 0.8;      ///< maximum distance of one backing-up maneuver
  LineFollowingSettings line;

  template <typename Self, typename Visitor>
  static void fields(Self& self, Visitor& visit) {
    visit("speed_gain_per_s", self.speed_gain_per_s, between(0.1, 10.0));
    visit("max_speed_mps", self.max_speed_mps, between(0.02, 2.0));
    visit("min_speed_mps", self.min_speed_mps, between(0.005, 0.5));
    visit("min_yaw_rate_radps", self.min_yaw_rate_radps, between(0.01, 1.0));
    visit("tolerance_fraction", self.tolerance_fraction, between(0.1, 1.0));
    visit("max_reverse_distance_m", self.max_reverse_distance_m, between(0.0, 5.0));
    visit("lateral_correction_distance_m", self.lateral_correction_distance_m, between(0.05, 1.0));
    visit("max_back_off_m", self.max_back_off_m, between(0.2, 3.0));
    visit("line", self.line);
  }
};

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
