#pragma once

#include "core/navigation_goal.h"
#include "core/settings.h"
#include "plan/control/line_following.h"

namespace patrol::plan {

struct DifferentialApproachSettings {
  double speed_gain_per_s = 1.0;    ///< speed per metre left
  double max_speed_mps = 0.3;
  double min_speed_mps = 0.04;      ///< what the tracks still do evenly
  double min_yaw_rate_radps = 0.08; ///< likewise
  double aim_share = 0.5;           ///< of the goal's tolerances is aimed at; within the whole it ends a pass
  double reverse_m = 1.0;           ///< a goal nearer than this and behind is driven to backwards
  double shuffle_m = 0.25;          ///< nearer than this side errors are taken off by driving back and forth
  double max_back_off_m = 0.8;      ///< at most so far back
  LineFollowingSettings line;

  template <typename Self, typename Visitor>
  static void fields(Self& self, Visitor& visit) {
    visit("speed_gain_per_s", self.speed_gain_per_s, between(0.1, 10.0));
    visit("max_speed_mps", self.max_speed_mps, between(0.02, 2.0));
    visit("min_speed_mps", self.min_speed_mps, between(0.005, 0.5));
    visit("min_yaw_rate_radps", self.min_yaw_rate_radps, between(0.01, 1.0));
    visit("aim_share", self.aim_share, between(0.1, 1.0));
    visit("reverse_m", self.reverse_m, between(0.0, 5.0));
    visit("shuffle_m", self.shuffle_m, between(0.05, 1.0));
    visit("max_back_off_m", self.max_back_off_m, between(0.2, 3.0));
    visit("line", self.line);
  }
};

/// The last metre of a robot on tracks or two wheels: turn to the place, drive there, turn to the heading. What a skidding
/// turn has then moved it aside is taken off by backing up along the goal's axis and driving in again, since turning on
/// the spot for each centimetre aside would skid as much again.
class DifferentialApproach {
 public:
  explicit DifferentialApproach(const DifferentialApproachSettings& settings) : settings_(settings) {}

  /// For another goal, or after something else has driven.
  void reset();
  /// Once a control period. At the goal the command is to stand.
  VelocityCommand step(const Pose2& T_map_body, const NavigationGoal& goal);
  /// Within the share of the tolerances that is aimed at; or within the tolerances at the end of a pass.
  bool is_done() const { return phase_ == Phase::kDone; }
  /// There is no room for the last command: the next way back and forth begins at the other end.
  void block();

 private:
  enum class Phase { kChoose, kTurnToPlace, kDriveToPlace, kTurnToHeading, kBackOff, kDriveLine, kDone };

  Phase choose(const Pose2& T_goal_body, const NavigationGoal& goal) const;
  VelocityCommand turn_to_place(const Pose2& T_goal_body);
  VelocityCommand drive_to_place(const Pose2& T_goal_body, const NavigationGoal& goal);
  VelocityCommand turn_to_heading(const Pose2& T_goal_body, const NavigationGoal& goal);
  VelocityCommand back_off(const Pose2& T_goal_body, const NavigationGoal& goal);
  VelocityCommand drive_line(const Pose2& T_goal_body, const NavigationGoal& goal);
  double speed_mps(double left_m) const;
  double yaw_rate_radps(double turn_rad) const;

  DifferentialApproachSettings settings_;
  Phase phase_ = Phase::kChoose;
  double forward_ = 1.0;         ///< -1: this leg is driven backwards
  double back_off_side_ = -1.0;  ///< along the goal's x axis
};

}  // namespace patrol::plan
