#include "sim/locomotion/leg_gains.h"

#include <algorithm>
#include <cmath>

#include "core/leg_kinematics.h"
#include "sim/leg_scale.h"
#include "sim/locomotion/locomotion_settings.h"
#include "sim/locomotion/swing_speed.h"

namespace patrol::sim {
namespace {

// Robot for which the gains are tuned (models/quadruped), see leg_scale.cc.
/// Part of the rotors in the vertical inertia of a leg at its foot, 0.745 kg in the standing posture.
constexpr double kTunedRotorFraction = 0.73;
const Eigen::Vector3d kTunedCenter_m(-0.0012, 0.0, -0.0093);
const Eigen::Vector3d kTunedInertiaPerKg_m2(0.01104, 0.03059, 0.03026);

/// Returns the ratio of the inertia of a leg at its foot. The inertia of the rotors is proportional to their torque, at
/// the foot divided by the square of the length; that of the links is proportional to the mass.
double swing_inertia_ratio(const RobotDescription& robot, const LegScale& scale) {
  return rounded_to_percent(kTunedRotorFraction * motor_ratio(robot, 0) / (scale.length * scale.length) +
                            (1.0 - kTunedRotorFraction) * scale.force);
}

}  // namespace

LegGains scaled_leg_gains(const RobotDescription& robot) {
  const LegScale scale = leg_scale(robot);
  const auto [length, time, force] = scale;
  LegGains gains;
  for (double* stiffness : {&gains.height_stiffness, &gains.velocity_integral, &gains.standing_stiffness,
                            &gains.tilt_stiffness, &gains.yaw_stiffness}) {
    *stiffness /= time * time;
  }
  for (double* damping : {&gains.height_damping, &gains.velocity_gain, &gains.standing_damping, &gains.tilt_damping,
                          &gains.yaw_damping}) {
    *damping /= time;
  }
  for (double* distance_m : {&gains.max_velocity_integral_m, &gains.max_standing_offset_m, &gains.max_step_m,
                             &gains.max_search_m, &gains.collapsed_m}) {
    *distance_m *= length;
  }
  for (double* speed_mps : {&gains.search_speed_mps, &gains.max_stop_speed_mps}) *speed_mps *= length / time;
  for (double* time_s : {&gains.capture_time_s, &gains.ground_time_s, &gains.velocity_time_s}) *time_s *= time;
  const double swing_inertia = swing_inertia_ratio(robot, scale);
  gains.swing_stiffness_npm *= std::min(force, swing_inertia) / length;  // stiffer, a light leg would oscillate
  gains.swing_damping_nspm *= swing_inertia / time;
  gains.wake_up_stiffness_npm *= force / length;
  gains.wake_up_damping_nspm *= force / time;
  for (double* force_n : {&gains.touch_force_n, &gains.min_foot_force_n, &gains.max_foot_force_n}) *force_n *= force;
  for (Eigen::Index axis = 0; axis < 3; ++axis) {
    const double per_kg_m2 = robot.standing_inertia_kgm2[axis] / robot.mass_kg;
    gains.inertia_per_kg_m2[axis] *= rounded_to_percent(per_kg_m2 / kTunedInertiaPerKg_m2[axis]);
  }
  constexpr double kStep_m = 0.005;
  gains.center_m = kStep_m * ((robot.standing_center_m - length * kTunedCenter_m) / kStep_m).array().round();
  return gains;
}

LocomotionSettings scaled_locomotion(const RobotDescription& robot) {
  constexpr double kAboveStanding = 1.0108;  // 0.300 m for the tuned robot, whose standing posture is 0.297 m high
  const auto [length, time, force] = leg_scale(robot);
  double height_m = 0.0;
  for (const LegGeometry& leg : robot.legs) height_m = std::max(height_m, -foot_position(leg, leg.standing_rad).z());

  LocomotionSettings settings;
  settings.gait_period_s *= time;
  settings.trunk_height_m = std::round(1000.0 * kAboveStanding * height_m) / 1000.0;
  settings.moment_arm_m = settings.trunk_height_m;
  settings.redistributes_forces = true;
  settings.swing_clearance_m *= length;
  for (double* speed_mps : {&settings.max_forward_mps, &settings.max_backward_mps, &settings.max_sideways_mps})
    *speed_mps *= length / time;
  settings.max_yaw_rate_radps /= time;
  settings.max_yaw_acceleration_radps2 /= time * time;
  limit_to_joint_speeds(robot, settings);
  return settings;
}

}  // namespace patrol::sim
