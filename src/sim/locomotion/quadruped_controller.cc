#include "sim/locomotion/quadruped_controller.h"

#include <algorithm>
#include <cmath>

#include <Eigen/Cholesky>

#include "core/frames.h"
#include "core/geometry/linear_algebra.h"
#include "sim/locomotion/swing_trajectory.h"
#include "sim/locomotion/velocity_ramp.h"

namespace patrol::sim {
namespace {

constexpr double kGravity = 9.81;  // m/s2

// Virtual model of the trunk. Translation: stiffness and damping per kg of robot mass. Rotation: per kg m2 of trunk
// inertia.
constexpr double kHeightStiffness = 120.0, kHeightDamping = 14.0;  // 1/s2, 1/s
constexpr double kVelocityGain = 5.0, kVelocityIntegral = 3.0;     // 1/s, 1/s2
constexpr double kMaxIntegral_m = 0.3;
constexpr double kStandingStiffness = 60.0, kStandingDamping = 10.0;  // 1/s2, 1/s; about the center of the feet
constexpr double kMaxStandingOffset_m = 0.02;                         // of the place at which the robot came to a stand
constexpr double kTiltStiffness = 400.0, kTiltDamping = 40.0;         // 1/s2, 1/s
constexpr double kYawStiffness = 80.0, kYawDamping = 14.0;            // 1/s2, 1/s
const Eigen::Vector3d kInertiaPerKg(0.008, 0.024, 0.028);  // inertia of the whole robot about roll, pitch and
                                                           // yaw, divided by its mass, m2

// Impedance of a swing foot about its trajectory.
constexpr double kSwingStiffness = 700.0, kSwingDamping = 16.0;  // N/m, N s/m
constexpr double kCaptureTime_s = 0.06;  // lead of the foot placement per m/s of velocity error [Raibert86]
constexpr double kSearchSpeed_mps = 0.35, kMaxSearch_m = 0.10;

// Impedance of the feet about the standing posture, until the estimator has settled.
constexpr double kWakeUp_s = 1.2;
constexpr double kWakeUpStiffness = 3000.0, kWakeUpDamping = 60.0;  // N/m, N s/m

constexpr double kGroundTime_s = 0.15;  // time constant of the ground estimate below the feet
constexpr double kEarlyTouch = 0.55;    // swing fraction from which a contact counts as touch-down
constexpr double kStandSpeed_mps = 0.02, kStandRate_radps = 0.03;

}  // namespace

QuadrupedController::QuadrupedController(const RobotDescription& robot, const LocomotionSettings& settings,
                                         double tick_s)
    : robot_(robot),
      settings_(settings),
      gait_{.period_s = settings.gait_period_s, .duty = settings.gait_duty},
      tick_s_(tick_s),
      estimator_(robot, tick_s),
      ground_offset_m_(-settings.trunk_height_m) {
  validate(settings, "locomotion");
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
  if (is_walking_ && idle_s_ > gait_.period_s && all_stand && trunk.velocity_mps.head<2>().norm() < 0.12) {
    is_walking_ = false;
    velocity_integral_.setZero();
  }
}

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
    if (phase_[leg].is_stance && !phase.is_stance) {  // lift-off
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
      if (trunk.is_touching[leg] || search_s_[leg] * kSearchSpeed_mps > kMaxSearch_m) is_searching_[leg] = false;
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
  const double blend = tick_s_ / kGroundTime_s;
  slope_ += blend * (plane.head<2>() - slope_);
  slope_ = slope_.cwiseMax(-0.4).cwiseMin(0.4);
  ground_offset_m_ = plane.z();
}

/// Returns the touch-down point of a swing foot, in level.
Eigen::Vector3d QuadrupedController::touch_down(const TrunkState& trunk, int leg) const {
  const LegGeometry& geometry = robot_.legs[static_cast<std::size_t>(leg)];
  const Eigen::Vector2d hip = geometry.hip_in_body.head<2>() + Eigen::Vector2d(0.0, geometry.abduction_offset_m);
  const Eigen::Vector2d turning = trunk.rate_radps.z() * Eigen::Vector2d(-hip.y(), hip.x());
  const Eigen::Vector2d velocity = trunk.velocity_mps.head<2>();
  const Eigen::Vector2d step =
      (velocity + turning) * gait_.stance_s() / 2.0 + kCaptureTime_s * (velocity - velocity_mps_);
  // The ground pushes the feet sideways in a turn, and lastingly when the estimate of the vertical is tilted (bias of
  // the accelerometer). This offset keeps the push in line with the trunk, which would roll over otherwise. Pitch needs
  // no offset: the feet are farther apart along x.
  const Eigen::Vector2d push_mps2 = yaw_rate_radps_ * Eigen::Vector2d(-velocity.y(), velocity.x()) +
                                    Eigen::Vector2d(0.0, kVelocityIntegral * velocity_integral_.y());
  const Eigen::Vector2d outwards = -settings_.trunk_height_m / kGravity * push_mps2;
  const Eigen::Vector2d foot = hip + outwards + step.cwiseMax(-0.2).cwiseMin(0.2);
  return {foot.x(), foot.y(), ground_offset_m_ + slope_.dot(foot)};
}

/// Returns the force that pulls a swing (or searching) foot to its trajectory, in level.
Eigen::Vector3d QuadrupedController::swing_force(const TrunkState& trunk, int leg) const {
  FootMotion wanted = swing_foot(lift_off_m_[leg], touch_down(trunk, leg), settings_.swing_clearance_m,
                                 phase_[leg].is_stance ? 1.0 : phase_[leg].fraction, gait_.swing_s());
  if (is_searching_[leg]) {
    wanted.position.z() -= kSearchSpeed_mps * search_s_[leg];
    wanted.velocity = Eigen::Vector3d(0.0, 0.0, -kSearchSpeed_mps);
  }
  return kSwingStiffness * (wanted.position - trunk.foot_m[leg]) +
         kSwingDamping * (wanted.velocity - trunk.foot_velocity_mps[leg]);
}

/// Returns the force that holds the standing posture without the estimated tilt, in level.
Eigen::Vector3d QuadrupedController::wake_up_force(const TrunkState& trunk, int leg) const {
  const LegGeometry& geometry = robot_.legs[static_cast<std::size_t>(leg)];
  const Eigen::Vector3d posture = geometry.hip_in_body + Eigen::Vector3d(0.0, geometry.abduction_offset_m, 0.0);
  const Eigen::Vector3d foot_in_body(posture.x(), posture.y(), -settings_.trunk_height_m);
  const Eigen::Vector3d weight(0.0, 0.0, robot_.mass_kg * kGravity / kNumLegs);
  const Eigen::Vector3d error = foot_in_body - trunk.R_level_body.transpose() * trunk.foot_m[leg];
  const Eigen::Vector3d velocity = trunk.foot_velocity_mps[leg] - trunk.rate_radps.cross(trunk.foot_m[leg]);
  return weight - trunk.R_level_body * (kWakeUpStiffness * error) + kWakeUpDamping * velocity;
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
  Eigen::Vector2d hip_center = Eigen::Vector2d::Zero();
  double dot = 0.0, cross = 0.0;
  for (int leg = 0; leg < kNumLegs; ++leg) {
    const Eigen::Vector2d first = (*standing_foot_m_)[leg].head<2>() - first_center,
                          now = trunk.foot_m[leg].head<2>() - center_now;
    dot += first.dot(now);
    cross += first.x() * now.y() - first.y() * now.x();
    hip_center += robot_.legs[static_cast<std::size_t>(leg)].hip_in_body.head<2>() / kNumLegs;
  }
  const Eigen::Vector2d offset =
      (first_center - hip_center).cwiseMax(-kMaxStandingOffset_m).cwiseMin(kMaxStandingOffset_m);
  return {.p_m = center_now - hip_center - offset, .angle_rad = std::atan2(cross, dot)};
}

FootVectors QuadrupedController::stance_forces(const TrunkState& trunk) {
  const Eigen::Vector2d velocity = trunk.velocity_mps.head<2>();
  const Eigen::Vector2d velocity_error = velocity_mps_ - velocity;
  if (is_walking_) {
    velocity_integral_ += tick_s_ * velocity_error;
  } else {
    const StandingError standing = standing_error(trunk);
    yaw_rad_ = trunk.yaw_rad + standing.angle_rad;
    velocity_integral_ = kStandingStiffness / kVelocityIntegral * standing.p_m;  // the first step continues with it
  }
  velocity_integral_ = velocity_integral_.cwiseMax(-kMaxIntegral_m).cwiseMin(kMaxIntegral_m);
  const double height_m = -ground_offset_m_;
  Eigen::Vector3d force;
  const double velocity_gain = is_walking_ ? kVelocityGain : kStandingDamping;
  const Eigen::Vector2d centripetal = yaw_rate_radps_ * Eigen::Vector2d(-velocity.y(), velocity.x());
  force.head<2>() =
      robot_.mass_kg * (velocity_gain * velocity_error + kVelocityIntegral * velocity_integral_ + centripetal);
  force.z() = robot_.mass_kg * (kGravity + kHeightStiffness * (settings_.trunk_height_m - height_m) -
                                kHeightDamping * (trunk.velocity_mps.z() - slope_.dot(velocity)));

  const double wanted_pitch = -settings_.slope_following * std::atan(slope_.x());
  const double wanted_roll = settings_.slope_following * std::atan(slope_.y());
  const Eigen::Vector3d tilt_error(wanted_roll - trunk.roll_rad, wanted_pitch - trunk.pitch_rad,
                                   wrap_angle(yaw_rad_ - trunk.yaw_rad));
  const Eigen::Vector3d rate_error(-trunk.rate_radps.x(), -trunk.rate_radps.y(),
                                   yaw_rate_radps_ - trunk.rate_radps.z());
  const Eigen::Vector3d stiffness(kTiltStiffness, kTiltStiffness, kYawStiffness);
  const Eigen::Vector3d damping(kTiltDamping, kTiltDamping, kYawDamping);
  const Eigen::Vector3d moment = robot_.mass_kg * kInertiaPerKg.cwiseProduct(stiffness.cwiseProduct(tilt_error) +
                                                                             damping.cwiseProduct(rate_error));
  FootFlags is_loaded;
  for (int leg = 0; leg < kNumLegs; ++leg) is_loaded[leg] = is_stance_[leg] && !is_searching_[leg];
  return distribute_wrench(force, moment, trunk.foot_m, is_loaded, {});
}

void QuadrupedController::detect_fall(const TrunkState& trunk) {
  constexpr double kFallenTilt_rad = M_PI / 3.0, kCollapsed_m = 0.12;
  const bool is_tilted = std::cos(trunk.roll_rad) * std::cos(trunk.pitch_rad) < std::cos(kFallenTilt_rad);
  const bool is_collapsed = -ground_offset_m_ < kCollapsed_m;
  fallen_s_ = is_tilted || is_collapsed ? fallen_s_ + tick_s_ : 0.0;
}

}  // namespace patrol::sim
