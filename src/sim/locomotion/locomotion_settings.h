#pragma once

#include "core/robot_description.h"
#include "core/settings.h"

namespace patrol::sim {

/// Settings of the walking firmware. The defaults are those of the robot for which the gains are tuned; for other
/// robots, a scenario starts from `scaled_locomotion`.
struct LocomotionSettings {
  double gait_period_s = 0.36;               ///< duration of a gait cycle
  double gait_duty = 0.6;                    ///< fraction of the gait cycle in which a foot is on the ground
  double trunk_height_m = 0.30;              ///< height of the trunk above the feet
  double swing_clearance_m = 0.09;           ///< clearance of a swing foot above the higher end of its trajectory
  double max_forward_mps = 1.0;              ///< maximum forward speed
  double max_backward_mps = 0.3;             ///< maximum backward speed
  double max_sideways_mps = 0.3;             ///< maximum lateral speed
  double max_yaw_rate_radps = 1.0;           ///< maximum yaw rate
  double max_acceleration_mps2 = 0.8;        ///< maximum acceleration of the commanded velocity
  double max_yaw_acceleration_radps2 = 2.0;  ///< maximum acceleration of the commanded yaw rate
  /// Fraction of the slope of the ground that the trunk follows: 0 keeps the trunk level on a slope, 1 parallel to the
  /// ground.
  double slope_following = 0.6;
  /// Length by which the force distribution weighs moments: an error of 1 N counts as one of 1 N times this length. Two
  /// stance feet cannot exert each wrench. The shorter the length, the less the trunk sways.
  double moment_arm_m = 1.0;
  /// Whether the other stance feet take over from a foot that would have to pull. Otherwise its force is clipped, and
  /// the others may lift the robot.
  bool redistributes_forces = false;

  template <typename Self, typename Visitor>
  static void fields(Self& self, Visitor& visit) {
    visit("gait_period_s", self.gait_period_s, between(0.2, 2.0));
    visit("gait_duty", self.gait_duty, between(0.5, 0.8));
    visit("trunk_height_m", self.trunk_height_m, between(0.05, 1.5));
    visit("swing_clearance_m", self.swing_clearance_m, between(0.01, 0.5));
    visit("max_forward_mps", self.max_forward_mps, between(0.1, 3.0));
    visit("max_backward_mps", self.max_backward_mps, between(0.0, 2.0));
    visit("max_sideways_mps", self.max_sideways_mps, between(0.0, 1.5));
    visit("max_yaw_rate_radps", self.max_yaw_rate_radps, between(0.1, 3.0));
    visit("max_acceleration_mps2", self.max_acceleration_mps2, between(0.1, 3.0));
    visit("max_yaw_acceleration_radps2", self.max_yaw_acceleration_radps2, between(0.1, 10.0));
    visit("slope_following", self.slope_following, between(0.0, 1.0));
    visit("moment_arm_m", self.moment_arm_m, between(0.02, 10.0));
    visit("redistributes_forces", self.redistributes_forces);
  }
};

/// Returns the settings for a robot with legs: lengths are proportional to the length of the legs, times and speeds to
/// its square root; the trunk is 1 % above the standing posture. The moment arm is the height of the trunk, the arm of
/// the horizontal forces of the feet. The swing is lower, the period longer and the robot slower if its joints are
/// too slow; a small robot swings its feet higher, because of steps (swing_speed.h).
LocomotionSettings scaled_locomotion(const RobotDescription& robot);

}  // namespace patrol::sim
