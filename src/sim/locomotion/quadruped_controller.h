#pragma once

#include <optional>

#include <Eigen/Core>

#include "core/messages.h"
#include "core/robot_description.h"
#include "core/sensors/registry.h"
#include "sim/locomotion/force_distribution.h"
#include "sim/locomotion/gait.h"
#include "sim/locomotion/leg_gains.h"
#include "sim/locomotion/locomotion_settings.h"
#include "sim/locomotion/trunk_estimator.h"

namespace patrol::sim {

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

  template <typename Archive>
  void serialize_state(Archive& archive) {
    archive(estimator_, velocity_mps_, yaw_rate_radps_, yaw_rad_, velocity_integral_, standing_foot_m_, is_walking_,
            idle_s_, cycle_, phase_, is_stance_, is_searching_, search_s_, awake_s_, lift_off_m_, foothold_m_, slope_,
            ground_offset_m_, fallen_s_);
  }

 private:
  void follow_command(const VelocityCommand& command);
  void choose_mode(const TrunkState& trunk);
  bool is_stopping(const TrunkState& trunk) const;
  void update_ground(const TrunkState& trunk);
  void schedule_feet(const TrunkState& trunk);
  Eigen::Vector2d neutral_foot_m(int leg) const;
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
  LegGains gains_;
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
