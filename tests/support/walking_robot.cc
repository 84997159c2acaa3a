#include "tests/support/walking_robot.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <stdexcept>

#include <Eigen/Geometry>
#include <Eigen/LU>

#include "core/leg_kinematics.h"

namespace patrol::test {
namespace {

constexpr int kSubsteps = 4;
constexpr double kGravity = 9.81;
constexpr double kClearance_m = 0.08;
constexpr double kLoad_n = 60.0;

Eigen::Matrix3d cross_matrix(const Eigen::Vector3d& v) {
  Eigen::Matrix3d m;
  m << 0.0, -v.z(), v.y(), v.z(), 0.0, -v.x(), -v.y(), v.x(), 0.0;
  return m;
}

/// Rates of abduction, hip and knee to the shank's rate relative to the trunk.
Eigen::Matrix3d shank_axes(double abduction_rad) {
  const Eigen::Vector3d pitch(0.0, std::cos(abduction_rad), std::sin(abduction_rad));
  Eigen::Matrix3d axes;
  axes << Eigen::Vector3d::UnitX(), pitch, pitch;
  return axes;
}

Eigen::Vector3d normal3(const RandomStream& stream, std::int64_t tick, std::uint64_t index) {
  const auto t = static_cast<std::uint64_t>(tick);
  return {stream.normal(t, index), stream.normal(t, index + 1), stream.normal(t, index + 2)};
}

}  // namespace

RobotDescription make_quadruped() {
  RobotDescription robot;
  robot.name = "quadruped";
  robot.mass_kg = 13.5;
  const std::array<const char*, 4> names{"FL", "FR", "RL", "RR"};
  for (int i = 0; i < 4; ++i) {
    const double front = i < 2 ? 1.0 : -1.0, left = i % 2 == 0 ? 1.0 : -1.0;
    robot.legs.push_back({.name = names[static_cast<std::size_t>(i)],
                          .hip_in_body = {front * 0.188, left * 0.047, 0.0},
                          .abduction_offset_m = left * 0.08,
                          .thigh_m = 0.213,
                          .shank_m = 0.213,
                          .foot_radius_m = 0.02});
  }
  robot.T_body_sensor["imu"] = Pose3{};
  robot.T_body_sensor["lidar"] = Pose3{{-0.02, 0.0, 0.175}, Eigen::Quaterniond::Identity()};
  return robot;
}

Walk stand_then_walk(double stand_s, const PlanarVelocity& velocity) {
  return [=](double time_s) {
    const double u = std::clamp(time_s - stand_s, 0.0, 1.0);
    const double share = u * u * (3.0 - 2.0 * u);
    return PlanarVelocity{share * velocity.vx_mps, share * velocity.vy_mps, share * velocity.yaw_rate_radps};
  };
}

WalkingRobotSettings WalkingRobotSettings::without_noise() {
  WalkingRobotSettings settings;
  settings.gyro_noise_radps_per_sqrt_hz = settings.accel_noise_mps2_per_sqrt_hz = 0.0;
  settings.joint_noise_rad = settings.joint_speed_noise_radps = 0.0;
  settings.gyro_bias_radps.setZero();
  settings.accel_bias_mps2.setZero();
  return settings;
}

WalkingRobot::WalkingRobot(const RobotDescription& robot, Walk walk, const WalkingRobotSettings& settings,
                           std::uint64_t seed)
    : robot_(robot),
      walk_(std::move(walk)),
      settings_(settings),
      gyro_noise_(seed, "imu/gyro"),
      accel_noise_(seed, "imu/accel"),
      joint_noise_(seed, "joint/angle"),
      speed_noise_(seed, "joint/speed"),
      force_noise_(seed, "foot/force") {
  place_trunk();
  for (int i = 0; i < 4; ++i) {
    Leg& leg = legs_[static_cast<std::size_t>(i)];
    leg.center = swing_center(i, 1.0);
    leg.angle_rad = *joint_angles(robot_.legs[static_cast<std::size_t>(i)], T_world_body_.inverse() * leg.center);
    leg.speed_radps.setZero();
  }
}

Time WalkingRobot::now() const { return from_seconds(settings_.period_s) * tick_; }

void WalkingRobot::step() {
  for (int i = 0; i < kSubsteps; ++i) substep();
  ++tick_;
  time_s_ = to_seconds(now());
}

Eigen::Vector3d WalkingRobot::level_velocity_in_world(double time_s, double yaw_rad) const {
  const PlanarVelocity v = walk_(time_s);
  return quaternion_from_yaw(yaw_rad) * Eigen::Vector3d(v.vx_mps, v.vy_mps, 0.0);
}

// Twice a gait period the trunk dips, once it rolls; fades in with the speed so that a standing robot stands
// still.
void WalkingRobot::place_trunk() {
  const PlanarVelocity walk = walk_(time_s_);
  constexpr double h = 1e-4;
  const double frequency = 2.0 * std::numbers::pi / settings_.gait_period_s;
  const auto fade = [&](double t) {
    const PlanarVelocity v = walk_(t);
    return std::min(1.0, std::hypot(v.vx_mps, v.vy_mps, 0.3 * v.yaw_rate_radps) / 0.3);
  };
  const auto rpyz = [&](double t) {
    return Eigen::Vector3d(fade(t) * settings_.roll_wobble_rad * std::sin(frequency * t),
                           settings_.slope_rad +
                               fade(t) * settings_.pitch_wobble_rad * std::sin(2.0 * frequency * t + 0.7),
                           settings_.height_m + fade(t) * settings_.height_wobble_m * std::sin(2.0 * frequency * t));
  };
  const Eigen::Vector3d here = rpyz(time_s_);
  const Eigen::Vector3d rate = (rpyz(time_s_ + h) - rpyz(time_s_ - h)) / (2.0 * h);
  const double rise = (rpyz(time_s_ + h).z() - 2.0 * here.z() + rpyz(time_s_ - h).z()) / (h * h);

  const Eigen::Matrix3d R_level_body =
      (Eigen::AngleAxisd(here[1], Eigen::Vector3d::UnitY()) * Eigen::AngleAxisd(here[0], Eigen::Vector3d::UnitX()))
          .toRotationMatrix();
  T_world_body_ = {{position_m_.x(), position_m_.y(), here.z()}, quaternion_from_rpy(here[0], here[1], yaw_rad_)};
  v_world_ = level_velocity_in_world(time_s_, yaw_rad_) + rate.z() * Eigen::Vector3d::UnitZ();
  a_world_ = (level_velocity_in_world(time_s_ + h, yaw_rad_ + h * walk.yaw_rate_radps) -
              level_velocity_in_world(time_s_ - h, yaw_rad_ - h * walk.yaw_rate_radps)) /
                 (2.0 * h) +
             rise * Eigen::Vector3d::UnitZ();
  // Rates of yaw, pitch and roll about their own axes, in body.
  omega_body_ =
      R_level_body.transpose() * (walk.yaw_rate_radps * Eigen::Vector3d::UnitZ() + rate[1] * Eigen::Vector3d::UnitY()) +
      rate[0] * Eigen::Vector3d::UnitX();
}

// A standing foot's center moves as the ball rolls: J q' = (omega + A q') x r n - v - omega x p, n the
// ground's normal in body.
Eigen::Vector3d WalkingRobot::rolling_speed(const LegGeometry& leg, int index, const Eigen::Vector3d& angle_rad) const {
  const Eigen::Matrix3d R = T_world_body_.rotation.toRotationMatrix();
  const Eigen::Vector3d rn = leg.foot_radius_m * R.transpose() * Eigen::Vector3d::UnitZ();
  Eigen::Vector3d slip = Eigen::Vector3d::Zero();
  if (settings_.slip) slip = settings_.slip(index, time_s_);
  const Eigen::Vector3d right =
      omega_body_.cross(rn) + R.transpose() * (slip - v_world_) - omega_body_.cross(foot_position(leg, angle_rad));
  return (foot_jacobian(leg, angle_rad) + cross_matrix(rn) * shank_axes(angle_rad[0])).inverse() * right;
}

bool WalkingRobot::should_stand(int index, double* swing_fraction) const {
  if (cycle_ == 0.0) return true;
  const double offset = (index == 0 || index == 3) ? 0.0 : 0.5;
  const double phase = cycle_ + offset - std::floor(cycle_ + offset);
  *swing_fraction = (phase - settings_.gait_duty) / (1.0 - settings_.gait_duty);
  return phase < settings_.gait_duty;
}

Eigen::Vector3d WalkingRobot::swing_center(int index, double fraction) const {
  const Leg& leg = legs_[static_cast<std::size_t>(index)];
  const LegGeometry& geometry = robot_.legs[static_cast<std::size_t>(index)];
  const Eigen::Vector2d hip = geometry.hip_in_body.head<2>() + Eigen::Vector2d(0.0, geometry.abduction_offset_m);
  const PlanarVelocity v = walk_(time_s_);
  const Eigen::Vector2d velocity(v.vx_mps - v.yaw_rate_radps * hip.y(), v.vy_mps + v.yaw_rate_radps * hip.x());
  const Eigen::Vector2d landing = Pose2{position_m_.x(), position_m_.y(), yaw_rad_} *
                                  Eigen::Vector2d(hip + velocity * settings_.gait_period_s * settings_.gait_duty / 2.0);
  const Eigen::Vector3d end(landing.x(), landing.y(), geometry.foot_radius_m);
  if (fraction >= 1.0) return end;
  const double u = fraction * fraction * (3.0 - 2.0 * fraction);
  Eigen::Vector3d center = leg.lift_off + u * (end - leg.lift_off);
  center.z() += kClearance_m * std::pow(std::sin(std::numbers::pi * fraction), 2);
  return center;
}

void WalkingRobot::substep() {
  const double dt = settings_.period_s / kSubsteps;
  const PlanarVelocity middle = walk_(time_s_ + dt / 2.0);
  std::array<Eigen::Vector3d, 4> speed_before;
  for (int i = 0; i < 4; ++i) {
    const auto leg = static_cast<std::size_t>(i);
    if (legs_[leg].is_standing) speed_before[leg] = rolling_speed(robot_.legs[leg], i, legs_[leg].angle_rad);
  }

  const Eigen::Vector3d v = level_velocity_in_world(time_s_ + dt / 2.0, yaw_rad_ + middle.yaw_rate_radps * dt / 2.0);
  position_m_ += dt * v.head<2>();
  way_m_ += dt * v.head<2>().norm();
  yaw_rad_ += dt * middle.yaw_rate_radps;
  time_s_ += dt;
  const bool walks = std::hypot(middle.vx_mps, middle.vy_mps) + std::abs(middle.yaw_rate_radps) > 1e-3;
  cycle_ = walks ? std::max(cycle_, 0.05) + dt / settings_.gait_period_s : 0.0;
  place_trunk();

  for (int i = 0; i < 4; ++i) {
    Leg& leg = legs_[static_cast<std::size_t>(i)];
    const LegGeometry& geometry = robot_.legs[static_cast<std::size_t>(i)];
    double fraction = 1.0;
    const bool stands = should_stand(i, &fraction);
    if (leg.is_standing) {  // Heun's method
      const Eigen::Vector3d guess = leg.angle_rad + dt * speed_before[static_cast<std::size_t>(i)];
      leg.angle_rad += 0.5 * dt * (speed_before[static_cast<std::size_t>(i)] + rolling_speed(geometry, i, guess));
      leg.speed_radps = rolling_speed(geometry, i, leg.angle_rad);
      leg.center = T_world_body_ * foot_position(geometry, leg.angle_rad);
    }
    if (leg.is_standing && !stands) leg.lift_off = leg.center;
    if (!stands || !leg.is_standing) {
      leg.center = swing_center(i, stands ? 1.0 : fraction);
      const auto angle = joint_angles(geometry, T_world_body_.inverse() * leg.center);
      if (!angle) throw std::logic_error("the walking robot of the tests cannot reach its next foothold");
      leg.speed_radps = stands ? rolling_speed(geometry, i, *angle) : Eigen::Vector3d((*angle - leg.angle_rad) / dt);
      leg.angle_rad = *angle;
    }
    leg.is_standing = stands;
  }
}

Imu WalkingRobot::imu() const {
  const double sqrt_rate = 1.0 / std::sqrt(settings_.period_s);
  const Eigen::Vector3d force = T_world_body_.rotation.conjugate() * (a_world_ + Eigen::Vector3d(0.0, 0.0, kGravity));
  return {.stamp = now(),
          .angular_velocity_radps = omega_body_ + settings_.gyro_bias_radps +
                                    settings_.gyro_noise_radps_per_sqrt_hz * sqrt_rate * normal3(gyro_noise_, tick_, 0),
          .linear_acceleration_mps2 =
              force + settings_.accel_bias_mps2 +
              settings_.accel_noise_mps2_per_sqrt_hz * sqrt_rate * normal3(accel_noise_, tick_, 0)};
}

JointState WalkingRobot::joints() const {
  JointState joints{
      .stamp = now(), .position_rad = {}, .velocity_radps = {}, .effort_nm = std::vector<double>(12, 0.0)};
  for (std::size_t i = 0; i < 4; ++i) {
    const Eigen::Vector3d angle = legs_[i].angle_rad + settings_.joint_noise_rad * normal3(joint_noise_, tick_, 3 * i);
    const Eigen::Vector3d speed =
        legs_[i].speed_radps + settings_.joint_speed_noise_radps * normal3(speed_noise_, tick_, 3 * i);
    joints.position_rad.insert(joints.position_rad.end(), angle.begin(), angle.end());
    joints.velocity_radps.insert(joints.velocity_radps.end(), speed.begin(), speed.end());
  }
  return joints;
}

FootContacts WalkingRobot::contacts() const {
  FootContacts contacts{.stamp = now(), .force_n = {}};
  for (std::size_t i = 0; i < 4; ++i) {
    const double noise = std::abs(force_noise_.normal(static_cast<std::uint64_t>(tick_), i));
    contacts.force_n.push_back(legs_[i].is_standing ? kLoad_n + noise : noise);
  }
  return contacts;
}

}  // namespace patrol::test
