#include "sim/locomotion/quadruped_controller.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include <Eigen/Cholesky>
#include <fmt/format.h>

#include "core/error.h"
#include "core/frames.h"
#include "core/geometry/linear_algebra.h"
#include "core/gravity.h"
#include "sim/locomotion/swing_trajectory.h"
#include "sim/locomotion/velocity_ramp.h"

namespace patrol::sim {
namespace {

constexpr double kWakeUp_s = 1.2;     // until the estimator has settled
constexpr double kEarlyTouch = 0.55;  // swing fraction from which a contact counts as touch-down
constexpr double kStandSpeed_mps = 0.02, kStandRate_radps = 0.03;

/// Checks that the feet can be `trunk_height_m` below the body. Throws InputError.
void check_trunk_height(const RobotDescription& robot, double trunk_height_m) {
  constexpr double kMinReach = 0.3, kMaxReach = 0.99;  // of the length of a leg
  for (const LegGeometry& leg : robot.legs) {
    const double hip_m = leg.hip_in_body.z();
    const double min_m = kMinReach * leg.length_m() - hip_m, max_m = kMaxReach * leg.length_m() - hip_m;
    if (trunk_height_m > min_m && trunk_height_m < max_m) continue;
    throw InputError(
        fmt::format("locomotion.trunk_height_m = {:g}: must be in ({:.2f}, {:.2f}), the reach of the legs of {}",
                    trunk_height_m, min_m, max_m, robot.name));
  }
}

}  // namespace

QuadrupedController::QuadrupedController(const RobotDescription& robot, const LocomotionSettings& settings,
                                         double tick_s)
    : robot_(robot),
      settings_(settings),
      gait_{.period_s = settings.gait_period_s, .duty = settings.gait_duty},
      gains_(scaled_leg_gains(robot)),
      tick_s_(tick_s),
      estimator_(robot, gains_.touch_force_n, gains_.velocity_time_s, tick_s),
      ground_offset_m_(-settings.trunk_height_m) {
  validate(settings, "locomotion");
  check_trunk_height(robot, settings.trunk_height_m);
  is_stance_.fill(true);
  lift_off_m_.fill(Eigen::Vector3d::Zero());
  foothold_m_.fill(Eigen::Vector3d(0.0, 0.0, -settings.trunk_height_m));
}

JointTorques QuadrupedController::step(const LegSensors& sensors, const VelocityCommand& command) {
  const TrunkState& trunk = estimator_.update(sensors.imu, sensors.joints, sensors.feet);
  follow_command(command);
  choose_mode(trunk);
  schedule_feet(trunk);
  update_ground(trunk);
  detect_fall(trunk);

  const FootVectors stance = stance_forces(trunk);
  JointTorques torques;
  for (int leg = 0; leg < kNumLegs; ++leg) {
    const Eigen::Vector3d force_on_ground = awake_s_ < kWakeUp_s                     ? wake_up_force(trunk, leg)
                                            : is_stance_[leg] && !is_searching_[leg] ? stance[leg]
                                                                                     : -swing_force(trunk, leg);
    torques.segment<3>(3 * leg) = -trunk.jacobian[leg].transpose() * force_on_ground;
    for (int k = 0; k < 3; ++k) {
      const double limit = robot_.joint_limits[static_cast<std::size_t>(3 * leg + k)].effort_nm;
      torques[3 * leg + k] = std::clamp(torques[3 * leg + k], -limit, limit);
    }
  }
  return torques;
}

void QuadrupedController::follow_command(const VelocityCommand& command) {
  awake_s_ += tick_s_;
  if (awake_s_ < kWakeUp_s) return;
  const double change = settings_.max_acceleration_mps2 * tick_s_;
  const double vx = std::clamp(command.vx_mps, -settings_.max_backward_mps, settings_.max_forward_mps);
  const double vy = std::clamp(command.vy_mps, -settings_.max_sideways_mps, settings_.max_sideways_mps);
  const double rate = std::clamp(command.yaw_rate_radps, -settings_.max_yaw_rate_radps, settings_.max_yaw_rate_radps);
  velocity_mps_.x() = moved_toward(velocity_mps_.x(), vx, change);
  velocity_mps_.y() = moved_toward(velocity_mps_.y(), vy, change);
  yaw_rate_radps_ = moved_toward(yaw_rate_radps_, rate, settings_.max_yaw_acceleration_radps2 * tick_s_);
  yaw_rad_ += tick_s_ * yaw_rate_radps_;
  // The requested heading leads the reached heading by at most 0.3 rad.
  const double lead = std::clamp(wrap_angle(yaw_rad_ - estimator_.state().yaw_rad), -0.3, 0.3);
  yaw_rad_ = estimator_.state().yaw_rad + lead;
}

// Walks while a velocity is requested and for one more period; then stands.
void QuadrupedController::choose_mode(const TrunkState& trunk) {
  const bool is_moving_commanded =
      velocity_mps_.norm() > kStandSpeed_mps || std::abs(yaw_rate_radps_) > kStandRate_radps;
  idle_s_ = is_moving_commanded ? 0.0 : idle_s_ + tick_s_;
  if (is_moving_commanded && !is_walking_) {
    is_walking_ = true;
    standing_foot_m_.reset();
    cycle_ = 0.02;  // FL and RR are in stance, FR and RL have half a stance left
  }
  const bool all_stand = is_stance_[0] && is_stance_[1] && is_stance_[2] && is_stance_[3] && !is_searching_[0] &&
                         !is_searching_[1] && !is_searching_[2] && !is_searching_[3];
  if (is_walking_ && all_stand && is_stopping(trunk)) {
    is_walking_ = false;
    velocity_integral_.setZero();
  }
}

bool QuadrupedController::is_stopping(const TrunkState& trunk) const {
  return idle_s_ > gait_.period_s && trunk.velocity_mps.head<2>().norm() < gains_.max_stop_speed_mps;
}

// A robot that stops lifts no foot: with late feet, there would be no moment at which all stand.
void QuadrupedController::schedule_feet(const TrunkState& trunk) {
  if (!is_walking_) {
    is_stance_.fill(true);
    is_searching_.fill(false);
    for (LegPhase& phase : phase_) phase = {};
    return;
  }
  cycle_ += tick_s_ / gait_.period_s;
  for (int leg = 0; leg < kNumLegs; ++leg) {
    const LegPhase phase = leg_phase(gait_, cycle_, leg);
    if (phase_[leg].is_stance && !phase.is_stance && !is_stopping(trunk)) {  // lift-off
      lift_off_m_[leg] = trunk.foot_m[leg];
      is_stance_[leg] = false;
      is_searching_[leg] = false;
    } else if (!phase_[leg].is_stance && phase.is_stance) {  // end of the swing
      is_searching_[leg] = !is_stance_[leg] && !trunk.is_touching[leg];
      is_stance_[leg] = true;
      search_s_[leg] = 0.0;
    }
    const bool found_early = !phase.is_stance && phase.fraction > kEarlyTouch && trunk.is_touching[leg];
    if (found_early) is_stance_[leg] = true;
    if (is_searching_[leg]) {
      search_s_[leg] += tick_s_;
      if (trunk.is_touching[leg] || search_s_[leg] * gains_.search_speed_mps > gains_.max_search_m)
        is_searching_[leg] = false;
    }
    phase_[leg] = phase;
  }
}

// Fits a plane to the four last footholds. The footholds of swing feet are moved against the trunk's motion.
void QuadrupedController::update_ground(const TrunkState& trunk) {
  const Eigen::Vector3d yaw_rate(0.0, 0.0, trunk.rate_radps.z());
  Eigen::Matrix3d normal = Eigen::Matrix3d::Zero();
  Eigen::Vector3d right = Eigen::Vector3d::Zero();
  for (int leg = 0; leg < kNumLegs; ++leg) {
    Eigen::Vector3d& foothold = foothold_m_[leg];
    if (is_stance_[leg] && !is_searching_[leg]) {
      foothold = trunk.foot_m[leg];
    } else {
      foothold -= tick_s_ * (trunk.velocity_mps + yaw_rate.cross(foothold));
    }
    const Eigen::Vector3d row(foothold.x(), foothold.y(), 1.0);
    normal += row * row.transpose();
    right += row * foothold.z();
  }
  normal.diagonal().head<2>().array() += 1e-3;
  const Eigen::Vector3d plane = solve_symmetric(normal, right);
  const double blend = tick_s_ / gains_.ground_time_s;
  slope_ += blend * (plane.head<2>() - slope_);
  slope_ = slope_.cwiseMax(-0.4).cwiseMin(0.4);
  ground_offset_m_ = plane.z();
}

/// Returns the place of a foot in the standing posture, in body: below the hip, with the center of mass in the middle.
Eigen::Vector2d QuadrupedController::neutral_foot_m(int leg) const {
  const LegGeometry& geometry = robot_.legs[static_cast<std::size_t>(leg)];
  return geometry.hip_in_body.head<2>() + Eigen::Vector2d(0.0, geometry.abduction_offset_m) + gains_.center_m.head<2>();
}

/// Returns the touch-down point of a swing foot, in level.
Eigen::Vector3d QuadrupedController::touch_down(const TrunkState& trunk, int leg) const {
  const Eigen::Vector2d hip = neutral_foot_m(leg);
  const Eigen::Vector2d turning = trunk.rate_radps.z() * Eigen::Vector2d(-hip.y(), hip.x());
  const Eigen::Vector2d velocity = trunk.velocity_mps.head<2>();
  const Eigen::Vector2d step =
      (velocity + turning) * gait_.stance_s() / 2.0 + gains_.capture_time_s * (velocity - velocity_mps_);
  // The ground pushes the feet sideways in a turn, and lastingly when the estimate of the vertical is tilted (bias of
  // the accelerometer). This offset keeps the push in line with the trunk, which would roll over otherwise. Pitch needs
  // no offset: the feet are farther apart along x.
  const Eigen::Vector2d push_mps2 = yaw_rate_radps_ * Eigen::Vector2d(-velocity.y(), velocity.x()) +
                                    Eigen::Vector2d(0.0, gains_.velocity_integral * velocity_integral_.y());
  const Eigen::Vector2d outwards = -settings_.trunk_height_m / kGravity_mps2 * push_mps2;
  const Eigen::Vector2d foot = hip + outwards + step.cwiseMax(-gains_.max_step_m).cwiseMin(gains_.max_step_m);
  return {foot.x(), foot.y(), ground_offset_m_ + slope_.dot(foot)};
}

/// Returns the force that pulls a swing (or searching) foot to its trajectory, in level.
Eigen::Vector3d QuadrupedController::swing_force(const TrunkState& trunk, int leg) const {
  FootMotion wanted = swing_foot(lift_off_m_[leg], touch_down(trunk, leg), settings_.swing_clearance_m,
                                 phase_[leg].is_stance ? 1.0 : phase_[leg].fraction, gait_.swing_s());
  if (is_searching_[leg]) {
    wanted.position.z() -= gains_.search_speed_mps * search_s_[leg];
    wanted.velocity = Eigen::Vector3d(0.0, 0.0, -gains_.search_speed_mps);
  }
  return gains_.swing_stiffness_npm * (wanted.position - trunk.foot_m[leg]) +
         gains_.swing_damping_nspm * (wanted.velocity - trunk.foot_velocity_mps[leg]);
}

/// Returns the force that holds the standing posture without the estimated tilt, in level.
Eigen::Vector3d QuadrupedController::wake_up_force(const TrunkState& trunk, int leg) const {
  const Eigen::Vector2d posture = neutral_foot_m(leg);
  const Eigen::Vector3d foot_in_body(posture.x(), posture.y(), -settings_.trunk_height_m);
  const Eigen::Vector3d weight(0.0, 0.0, robot_.mass_kg * kGravity_mps2 / kNumLegs);
  const Eigen::Vector3d error = foot_in_body - trunk.R_level_body.transpose() * trunk.foot_m[leg];
  const Eigen::Vector3d velocity = trunk.foot_velocity_mps[leg] - trunk.rate_radps.cross(trunk.foot_m[leg]);
  return weight - trunk.R_level_body * (gains_.wake_up_stiffness_npm * error) + gains_.wake_up_damping_nspm * velocity;
}

/// Returns the error of the trunk's place and heading over its feet, from leg kinematics. A place held by the estimated
/// velocity and a heading held by the gyro would push the trunk off its feet, at the rates of their biases. The place
/// is that at which the robot came to a stand, if the trunk was about centered there: a step from an uncentered stand
/// falls. The heading is the one relative to the feet at that time.
QuadrupedController::StandingError QuadrupedController::standing_error(const TrunkState& trunk) {
  const auto center = [](const FootVectors& feet) -> Eigen::Vector2d {
    return (feet[0] + feet[1] + feet[2] + feet[3]).head<2>() / kNumLegs;
  };
  if (!standing_foot_m_ || awake_s_ < kWakeUp_s) standing_foot_m_ = trunk.foot_m;
  const Eigen::Vector2d first_center = center(*standing_foot_m_), center_now = center(trunk.foot_m);
  Eigen::Vector2d hip_center = gains_.center_m.head<2>();
  double dot = 0.0, cross = 0.0;
  for (int leg = 0; leg < kNumLegs; ++leg) {
    const Eigen::Vector2d first = (*standing_foot_m_)[leg].head<2>() - first_center,
                          now = trunk.foot_m[leg].head<2>() - center_now;
    dot += first.dot(now);
    cross += first.x() * now.y() - first.y() * now.x();
    hip_center += robot_.legs[static_cast<std::size_t>(leg)].hip_in_body.head<2>() / kNumLegs;
  }
  const Eigen::Vector2d offset =
      (first_center - hip_center).cwiseMax(-gains_.max_standing_offset_m).cwiseMin(gains_.max_standing_offset_m);
  return {.p_m = center_now - hip_center - offset, .angle_rad = std::atan2(cross, dot)};
}

FootVectors QuadrupedController::stance_forces(const TrunkState& trunk) {
  const Eigen::Vector3d center_m = trunk.R_level_body * gains_.center_m;  // in level
  const Eigen::Vector3d center_mps = trunk.velocity_mps + trunk.rate_radps.cross(center_m);
  const Eigen::Vector2d velocity = center_mps.head<2>();
  const Eigen::Vector2d velocity_error = velocity_mps_ - velocity;
  if (is_walking_) {
    velocity_integral_ += tick_s_ * velocity_error;
  } else {
    const StandingError standing = standing_error(trunk);
    yaw_rad_ = trunk.yaw_rad + standing.angle_rad;
    velocity_integral_ =
        gains_.standing_stiffness / gains_.velocity_integral * standing.p_m;  // the first step continues with it
  }
  velocity_integral_ =
      velocity_integral_.cwiseMax(-gains_.max_velocity_integral_m).cwiseMin(gains_.max_velocity_integral_m);
  const double height_m = -ground_offset_m_;
  Eigen::Vector3d force;
  const double velocity_gain = is_walking_ ? gains_.velocity_gain : gains_.standing_damping;
  const Eigen::Vector2d centripetal = yaw_rate_radps_ * Eigen::Vector2d(-velocity.y(), velocity.x());
  force.head<2>() =
      robot_.mass_kg * (velocity_gain * velocity_error + gains_.velocity_integral * velocity_integral_ + centripetal);
  force.z() = robot_.mass_kg * (kGravity_mps2 + gains_.height_stiffness * (settings_.trunk_height_m - height_m) -
                                gains_.height_damping * (center_mps.z() - slope_.dot(velocity)));

  const double wanted_pitch = -settings_.slope_following * std::atan(slope_.x());
  const double wanted_roll = settings_.slope_following * std::atan(slope_.y());
  const Eigen::Vector3d tilt_error(wanted_roll - trunk.roll_rad, wanted_pitch - trunk.pitch_rad,
                                   wrap_angle(yaw_rad_ - trunk.yaw_rad));
  const Eigen::Vector3d rate_error(-trunk.rate_radps.x(), -trunk.rate_radps.y(),
                                   yaw_rate_radps_ - trunk.rate_radps.z());
  const Eigen::Vector3d stiffness(gains_.tilt_stiffness, gains_.tilt_stiffness, gains_.yaw_stiffness);
  const Eigen::Vector3d damping(gains_.tilt_damping, gains_.tilt_damping, gains_.yaw_damping);
  const Eigen::Vector3d moment =
      robot_.mass_kg *
      gains_.inertia_per_kg_m2.cwiseProduct(stiffness.cwiseProduct(tilt_error) + damping.cwiseProduct(rate_error));
  FootVectors feet;  // from the center, in units of moment_arm_m
  const double unit_m = settings_.moment_arm_m;
  for (int leg = 0; leg < kNumLegs; ++leg) feet[leg] = (trunk.foot_m[leg] - center_m) / unit_m;
  FootFlags is_loaded;
  for (int leg = 0; leg < kNumLegs; ++leg) is_loaded[leg] = is_stance_[leg] && !is_searching_[leg];
  return distribute_wrench(force, moment / unit_m, feet, is_loaded,
                           {.min_normal_n = gains_.min_foot_force_n,
                            .max_normal_n = gains_.max_foot_force_n,
                            .redistributes = settings_.redistributes_forces});
}

void QuadrupedController::detect_fall(const TrunkState& trunk) {
  constexpr double kFallenTilt_rad = std::numbers::pi / 3.0;
  const bool is_tilted = std::cos(trunk.roll_rad) * std::cos(trunk.pitch_rad) < std::cos(kFallenTilt_rad);
  const bool is_collapsed = -ground_offset_m_ < gains_.collapsed_m;
  fallen_s_ = is_tilted || is_collapsed ? fallen_s_ + tick_s_ : 0.0;
}

}  // namespace patrol::sim
