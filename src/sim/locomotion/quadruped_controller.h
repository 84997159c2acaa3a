#pragma once

#include <optional>

#include <Eigen/Core>

#include "core/messages.h"
#include "core/robot_description.h"
#include "core/sensors/registry.h"
#include "core/settings.h"
#include "sim/locomotion/force_distribution.h"
#include "sim/locomotion/gait.h"
#include "sim/locomotion/trunk_estimator.h"

namespace patrol::sim {

/// Settings of the walking firmware.
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

/// Newest sensor readings at a tick.
struct LegSensors {
  const Imu& imu;
  const JointState& joints;
  const FootContacts& feet;
};

using JointTorques = Eigen::Matrix<double, 3 * kNumLegs, 1>;

/// Trotting controller: converts a velocity command to joint torques from joint encoders, IMU and foot contacts.
///
/// Stance feet jointly exert a wrench on the trunk (height, roll, pitch, yaw, velocity) by virtual model control
/// [Pratt01]. Swing feet move to the touch-down points of [Raibert86]. Without a command, and once slow, the robot
/// stands on four feet.
class QuadrupedController {
 public:
  QuadrupedController(const RobotDescription& robot, const LocomotionSettings& settings, double tick_s = 0.002);

  /// Returns the torques for one tick, N m, in the order of RobotDescription::joint_names.
  JointTorques step(const LegSensors& sensors, const VelocityCommand& command);

  /// Returns true once the trunk has been tilted beyond 60 degrees, or on the ground, for 0.3 s.
  bool has_fallen() const { return fallen_s_ > 0.3; }
  const TrunkState& trunk() const { return estimator_.state(); }

 private:
  void follow_command(const VelocityCommand& command);
  void choose_mode(const TrunkState& trunk);
  void update_ground(const TrunkState& trunk);
  void schedule_feet(const TrunkState& trunk);
  Eigen::Vector3d touch_down(const TrunkState& trunk, int leg) const;
  /// Displacement that the trunk needs, and rotation, in level.
  struct StandingError {
    Eigen::Vector2d p_m;
    double angle_rad;
  };
  Eigen::Vector3d wake_up_force(const TrunkState& trunk, int leg) const;
  StandingError standing_error(const TrunkState& trunk);
  FootVectors stance_forces(const TrunkState& trunk);
  Eigen::Vector3d swing_force(const TrunkState& trunk, int leg) const;
  void detect_fall(const TrunkState& trunk);

  RobotDescription robot_;
  LocomotionSettings settings_;
  Gait gait_;
  double tick_s_;
  TrunkEstimator estimator_;

  // Rate-limited command, in level.
  Eigen::Vector2d velocity_mps_ = Eigen::Vector2d::Zero();
  double yaw_rate_radps_ = 0.0;
  double yaw_rad_ = 0.0;
  Eigen::Vector2d velocity_integral_ = Eigen::Vector2d::Zero();  ///< integral of the velocity error, m
  std::optional<FootVectors> standing_foot_m_;  ///< in level, when the robot came to a stand; none: it walks

  // Gait state.
  bool is_walking_ = false;
  double idle_s_ = 0.0;
  double cycle_ = 0.0;
  std::array<LegPhase, kNumLegs> phase_;
  FootFlags is_stance_{};
  FootFlags is_searching_{};  ///< true: the stance has begun but the foot has no ground contact
  std::array<double, kNumLegs> search_s_{};
  double awake_s_ = 0.0;    ///< time since switch-on
  FootVectors lift_off_m_;  ///< foot position at lift-off, in level

  // Ground plane of the four last footholds: z = offset + slope . (x, y), in level.
  FootVectors foothold_m_;
  Eigen::Vector2d slope_ = Eigen::Vector2d::Zero();
  double ground_offset_m_;

  double fallen_s_ = 0.0;
};

}  // namespace patrol::sim
