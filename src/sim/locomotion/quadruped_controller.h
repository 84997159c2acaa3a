#pragma once

#include <Eigen/Core>

#include "core/messages.h"
#include "core/robot_description.h"
#include "core/sensors/registry.h"
#include "core/settings.h"
#include "sim/locomotion/force_distribution.h"
#include "sim/locomotion/gait.h"
#include "sim/locomotion/trunk_estimator.h"

namespace patrol::sim {

/// The walking firmware's settings.
struct LocomotionSettings {
  double gait_period_s = 0.36;
  double gait_duty = 0.6;
  double trunk_height_m = 0.30;       ///< above the feet
  double swing_clearance_m = 0.09;    ///< of a swinging foot over the higher of its two ends
  double max_forward_mps = 1.0;
  double max_backward_mps = 0.3;
  double max_sideways_mps = 0.3;
  double max_yaw_rate_radps = 1.0;
  double max_acceleration_mps2 = 0.8;
  double max_yaw_acceleration_radps2 = 2.0;
  double slope_following = 0.6;       ///< 0 keeps the trunk level on a slope, 1 parallel to the ground

  template <typename Self, typename Visitor>
  static void fields(Self& self, Visitor& visit) {
    visit("gait_period_s", self.gait_period_s, between(0.25, 1.0));
    visit("gait_duty", self.gait_duty, between(0.5, 0.8));
    visit("trunk_height_m", self.trunk_height_m, between(0.2, 0.36));
    visit("swing_clearance_m", self.swing_clearance_m, between(0.02, 0.15));
    visit("max_forward_mps", self.max_forward_mps, between(0.1, 1.2));
    visit("max_backward_mps", self.max_backward_mps, between(0.0, 0.5));
    visit("max_sideways_mps", self.max_sideways_mps, between(0.0, 0.4));
    visit("max_yaw_rate_radps", self.max_yaw_rate_radps, between(0.1, 1.2));
    visit("max_acceleration_mps2", self.max_acceleration_mps2, between(0.1, 3.0));
    visit("max_yaw_acceleration_radps2", self.max_yaw_acceleration_radps2, between(0.1, 10.0));
    visit("slope_following", self.slope_following, between(0.0, 1.0));
  }
};

/// What the firmware reads at a tick: the newest of each.
struct LegSensors {
  const Imu& imu;
  const JointState& joints;
  const FootContacts& feet;
};

using JointTorques = Eigen::Matrix<double, 3 * kNumLegs, 1>;

/// Walks: turns a velocity command into joint torques, from joint encoders, IMU and foot contact alone.
///
/// A trot. Feet that stand share a wrench on the trunk (height, roll, pitch, yaw, velocity: virtual model control, Pratt et
/// al. 2001); feet that swing go to where the trunk will need them (Raibert 1986). Without a command, and once slow, it
/// stands on four feet.
class QuadrupedController {
 public:
  QuadrupedController(const RobotDescription& robot, const LocomotionSettings& settings, double tick_s = 0.002);

  /// One tick; N m, in the order of RobotDescription::joint_names.
  JointTorques step(const LegSensors& sensors, const VelocityCommand& command);

  /// True once the trunk has been tilted beyond 60 degrees, or lain on the ground, for 0.3 s.
  bool has_fallen() const { return fallen_s_ > 0.3; }
  const TrunkState& trunk() const { return estimator_.state(); }

 private:
  void follow_command(const VelocityCommand& command);
  void choose_mode(const TrunkState& trunk);
  void update_ground(const TrunkState& trunk);
  void schedule_feet(const TrunkState& trunk);
  Eigen::Vector3d touch_down(const TrunkState& trunk, int leg) const;
  FootVectors stance_forces(const TrunkState& trunk);
  Eigen::Vector3d swing_force(const TrunkState& trunk, int leg) const;
  void watch_for_fall(const TrunkState& trunk);

  RobotDescription robot_;
  LocomotionSettings settings_;
  Gait gait_;
  double tick_s_;
  TrunkEstimator estimator_;

  // Command, rate-limited; in level.
  Eigen::Vector2d velocity_mps_ = Eigen::Vector2d::Zero();
  double yaw_rate_radps_ = 0.0;
  double yaw_rad_ = 0.0;
  Eigen::Vector2d velocity_integral_ = Eigen::Vector2d::Zero();  ///< m
  Eigen::Vector2d anchor_m_ = Eigen::Vector2d::Zero();  ///< while standing: way from where it came to stand

  // Gait.
  bool is_walking_ = false;
  double idle_s_ = 0.0;
  double cycle_ = 0.0;
  std::array<LegPhase, kNumLegs> phase_;
  FootFlags is_stance_;
  FootFlags is_searching_{};                 ///< its stance has begun but it has not found the ground
  std::array<double, kNumLegs> search_s_{};
  double awake_s_ = 0.0;                     ///< since switched on
  FootVectors lift_off_m_;                   ///< in level, at lift-off

  // Ground under the four last footholds: z = offset + slope . (x, y), in level.
  FootVectors foothold_m_;
  Eigen::Vector2d slope_ = Eigen::Vector2d::Zero();
  double ground_offset_m_;

  double fallen_s_ = 0.0;
};

}  // namespace patrol::sim
