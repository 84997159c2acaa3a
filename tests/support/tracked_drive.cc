#include "tests/support/tracked_drive.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include <Eigen/Geometry>

namespace patrol::test {
namespace {

constexpr double kGravity_mps2 = 9.81;
constexpr double kStand_s = 3.0;

Eigen::Matrix3d draw_distortion(const RandomStream& constants, std::uint64_t triad, double scale, double misalignment) {
  Eigen::Matrix3d distortion = Eigen::Matrix3d::Identity();
  std::uint64_t index = 0;
  for (int row = 0; row < 3; ++row) {
    for (int col = 0; col < 3; ++col)
      distortion(row, col) += (row == col ? scale : misalignment) * constants.normal(triad, index++);
  }
  return distortion;
}

Eigen::Vector3d draw_vector(const RandomStream& stream, std::uint64_t tick, std::uint64_t first_index, double std) {
  return std * Eigen::Vector3d(stream.normal(tick, first_index), stream.normal(tick, first_index + 1),
                               stream.normal(tick, first_index + 2));
}

double quantized(double value, double resolution) {
  return resolution > 0.0 ? resolution * std::round(value / resolution) : value;
}

double towards(double value, double target, double most) { return value + std::clamp(target - value, -most, most); }

}  // namespace

RobotDescription make_tracked_robot() {
  RobotDescription robot;
  robot.name = "tracked";
  robot.mass_kg = 85.0;
  robot.tracks = TrackGeometry{
      .gauge_m = 0.55, .width_m = 0.15, .contact_length_m = 0.7, .sprocket_radius_m = 0.1, .body_height_m = 0.25};
  robot.T_body_sensor["imu"] = {{0.05, 0.03, 0.1}, Eigen::Quaterniond::Identity()};
  robot.T_body_sensor["uwb"] = {{-0.3, 0.1, 0.5}, Eigen::Quaterniond::Identity()};
  return robot;
}

BeltProgram stand_then_drive(const Belts& belts) {
  return [belts](double time_s, const Pose3&) { return time_s < kStand_s ? Belts{} : belts; };
}

BeltProgram stand_then_weave() {
  return [](double time_s, const Pose3& T_world_body) -> Belts {
    if (time_s < kStand_s) return {};
    const Pose2 body = to_pose2(T_world_body);
    const double wave = 2.0 * std::numbers::pi / 60.0;
    const double slope = std::atan(1.5 * wave * std::cos(wave * body.x));
    const double turn = 0.5 * wrap_angle(slope - body.yaw) + 0.3 * (1.5 * std::sin(wave * body.x) - body.y);
    const double half_difference = 0.4 * std::clamp(turn, -0.4, 0.4);
    return {0.5 - half_difference, 0.5 + half_difference};
  };
}

BeltProgram make_tour() {
  return [](double time_s, const Pose3&) -> Belts {
    if (time_s < kStand_s) return {};
    const double phase = std::fmod(time_s - kStand_s, 40.0);
    if (phase < 12.0) return {0.6, 0.6};
    if (phase < 18.0) return {0.4, 0.6};
    if (phase < 21.0) return {-0.3, 0.3};
    if (phase < 31.0) return {0.5, 0.5};
    if (phase < 35.0) return {0.6, 0.35};
    if (phase < 37.0) return {0.25, -0.25};
    return {};
  };
}

TrackedDriveSettings TrackedDriveSettings::without_noise() {
  return {.ticks_per_sprocket_turn = 1e6,
          .scale = 0.0,
          .slip = 0.0,
          .slip_per_radps = 0.0,
          .slip_per_tilt = 0.0,
          .crab = 0.0,
          .turn_ratio_std = 0.0,
          .icr_x_m = 0.0,
          .icr_y_m = 0.0,
          .vibration_mps2_rthz = 0.0,
          .gyro_noise_radps = 0.0,
          .gyro_bias_radps = 0.0,
          .gyro_bias_random_walk_radps_per_sqrt_s = 0.0,
          .accel_noise_mps2 = 0.0,
          .accel_bias_mps2 = 0.0,
          .accel_bias_random_walk_mps2_per_sqrt_s = 0.0,
          .imu_scale = 0.0,
          .imu_misalignment_rad = 0.0,
          .gyro_resolution_radps = 0.0,
          .accel_resolution_mps2 = 0.0};
}

TrackedDriveSettings TrackedDriveSettings::of_data_sheets() {
  const double root_period = std::sqrt(TrackedDriveSettings{}.imu_period_s);
  TrackedDriveSettings settings;
  settings.gyro_noise_radps = 2.36e-4 / root_period;
  settings.gyro_bias_radps = 8.7e-3;
  settings.accel_noise_mps2 = 2.26e-3 / root_period;
  settings.accel_bias_mps2 = 0.196;
  settings.imu_misalignment_rad = 0.0015;
  settings.scale = 0.015;
  settings.slip = 0.01;
  settings.slip_length_m = 1.0;
  settings.slip_per_radps = 0.05;
  settings.slip_per_tilt = 0.2;
  settings.crab = 0.01;
  settings.turn_ratio = 1.41;
  settings.turn_ratio_std = 0.08;
  settings.turn_length_rad = 1.0;
  settings.icr_x_m = 0.03;
  settings.icr_y_m = 0.03;
  settings.pitch_rad = 0.06;
  settings.roll_rad = 0.04;
  settings.vibration_mps2_rthz = 0.05;
  return settings;
}

void TrackedDrive::Wanderer::go(double share_of_length, double std, double normal) {
  const double a = std::exp(-share_of_length);
  value = a * value + std::sqrt(1.0 - a * a) * std * normal;
}

TrackedDrive::TrackedDrive(const RobotDescription& robot, BeltProgram program, const TrackedDriveSettings& settings,
                           std::uint64_t seed)
    : robot_(robot),
      program_(std::move(program)),
      settings_(settings),
      constants_(seed, "tracked_drive/constants"),
      wander_noise_(seed, "tracked_drive/wander"),
      imu_noise_(seed, "tracked_drive/imu"),
      step_(from_seconds(settings.imu_period_s)),
      steps_per_ticks_(std::llround(settings.tick_period_s / settings.imu_period_s)),
      scale_(settings.scale * constants_.normal(0)),
      gyro_distortion_(draw_distortion(constants_, 2, settings.imu_scale, settings.imu_misalignment_rad)),
      accel_distortion_(draw_distortion(constants_, 3, settings.imu_scale, settings.imu_misalignment_rad)),
      gyro_bias_(draw_vector(constants_, 4, 0, settings.gyro_bias_radps)),
      accel_bias_(draw_vector(constants_, 5, 0, settings.accel_bias_mps2)) {
  slip_left_.value = settings.slip * constants_.normal(1, 0);
  slip_right_.value = settings.slip * constants_.normal(1, 1);
  crab_.value = settings.crab * constants_.normal(1, 5);
  turn_ratio_.value = settings.turn_ratio_std * constants_.normal(1, 2);
  turn_x_.value = settings.icr_x_m * constants_.normal(1, 3);
  turn_y_.value = settings.icr_y_m * constants_.normal(1, 4);
  T_world_body_.position.z() = robot.tracks->body_height_m;
}

void TrackedDrive::step() {
  ++imu_steps_;
  const double dt_s = settings_.imu_period_s;
  run_belts(dt_s);
  slip_and_turn(dt_s);
  place_body(dt_s);
}

void TrackedDrive::run_belts(double dt_s) {
  const Belts asked = program_(to_seconds(now()), T_world_body_);
  const double most = settings_.max_belt_acceleration_mps2 * dt_s;
  contact_.left_mps = towards(contact_.left_mps, asked.left_mps, most);
  contact_.right_mps = towards(contact_.right_mps, asked.right_mps, most);
  belt_way_m_ += dt_s * Eigen::Vector2d(contact_.left_mps, contact_.right_mps);
}

void TrackedDrive::slip_and_turn(double dt_s) {
  const double tilt = (T_world_body_.rotation * Eigen::Vector3d::UnitZ()).head<2>().norm();
  const double slip_std =
      std::hypot(settings_.slip, settings_.slip_per_radps * yaw_rate_radps_, settings_.slip_per_tilt * tilt);
  slip_left_.go(std::abs(contact_.left_mps) * dt_s / settings_.slip_length_m, slip_std, draw(0));
  slip_right_.go(std::abs(contact_.right_mps) * dt_s / settings_.slip_length_m, slip_std, draw(1));
  crab_.go(std::abs(ahead_mps_) * dt_s / settings_.slip_length_m, settings_.crab, draw(5));
  const double turned = std::abs(yaw_rate_radps_) * dt_s / settings_.turn_length_rad;
  turn_ratio_.go(turned, settings_.turn_ratio_std, draw(2));
  turn_x_.go(turned, settings_.icr_x_m, draw(3));
  turn_y_.go(turned, settings_.icr_y_m, draw(4));

  const double left = (1.0 - scale_ - slip_left_.value) * contact_.left_mps;
  const double right = (1.0 - scale_ - slip_right_.value) * contact_.right_mps;
  const double distance = robot_.tracks->gauge_m * (settings_.turn_ratio + turn_ratio_.value);
  const double yaw_rate = (right - left) / distance;
  const double ahead = 0.5 * (left + right) + turn_y_.value * yaw_rate;
  const double most = (settings_.friction ? settings_.friction(to_seconds(now())) : 0.8) * kGravity_mps2 * dt_s;
  ahead_mps_ = towards(ahead_mps_, ahead, most);
  yaw_rate_radps_ = towards(yaw_rate_radps_, yaw_rate, most / (0.25 * robot_.tracks->gauge_m));
  leftward_mps_ = -turn_x_.value * yaw_rate_radps_ + crab_.value * ahead_mps_;
}

void TrackedDrive::place_body(double dt_s) {
  const Pose3 before = T_world_body_;
  const Eigen::Vector3d v_before = v_world_;
  way_m_ += std::abs(ahead_mps_) * dt_s;
  yaw_rad_ += yaw_rate_radps_ * dt_s;
  const double pitch = settings_.pitch_rad * std::sin(2.0 * std::numbers::pi * way_m_ / 7.0);
  const double roll = settings_.roll_rad * std::sin(2.0 * std::numbers::pi * way_m_ / 11.0);
  const Eigen::Quaterniond rotation = quaternion_from_rpy(roll, pitch, yaw_rad_);
  p_ground_ += dt_s * (rotation * Eigen::Vector3d(ahead_mps_, leftward_mps_, 0.0));
  T_world_body_ = {p_ground_ + rotation * Eigen::Vector3d(0.0, 0.0, robot_.tracks->body_height_m), rotation};

  const Eigen::Vector3d& p_body_imu = robot_.T_body("imu").position;
  v_world_ = (T_world_body_ * p_body_imu - before * p_body_imu) / dt_s;
  const Eigen::AngleAxisd turn(before.rotation.conjugate() * rotation);
  const Eigen::Vector3d acceleration = (v_world_ - v_before) / dt_s;
  measure_imu(turn.angle() / dt_s * turn.axis(),
              rotation.conjugate() * (acceleration + Eigen::Vector3d(0.0, 0.0, kGravity_mps2)));
}

void TrackedDrive::measure_imu(const Eigen::Vector3d& omega_body, const Eigen::Vector3d& force_body) {
  const auto tick = static_cast<std::uint64_t>(imu_steps_);
  const double root_s = std::sqrt(settings_.imu_period_s);
  gyro_bias_ += draw_vector(imu_noise_, tick, 0, settings_.gyro_bias_random_walk_radps_per_sqrt_s * root_s);
  accel_bias_ += draw_vector(imu_noise_, tick, 3, settings_.accel_bias_random_walk_mps2_per_sqrt_s * root_s);
  const double vibration =
      settings_.vibration_mps2_rthz / root_s * std::abs(0.5 * (contact_.left_mps + contact_.right_mps));
  Eigen::Vector3d rate =
      gyro_distortion_ * omega_body + gyro_bias_ + draw_vector(imu_noise_, tick, 6, settings_.gyro_noise_radps);
  Eigen::Vector3d force = accel_distortion_ * force_body + accel_bias_ +
                          draw_vector(imu_noise_, tick, 9, std::hypot(settings_.accel_noise_mps2, vibration));
  for (int axis = 0; axis < 3; ++axis) {
    rate[axis] = quantized(rate[axis], settings_.gyro_resolution_radps);
    force[axis] = quantized(force[axis], settings_.accel_resolution_mps2);
  }
  imu_ = {.stamp = now(), .angular_velocity_radps = rate, .linear_acceleration_mps2 = force};
}

TrackTicks TrackedDrive::ticks() const {
  const double meters_per_tick =
      2.0 * std::numbers::pi * robot_.tracks->sprocket_radius_m / settings_.ticks_per_sprocket_turn;
  return {.stamp = now(),
          .left = static_cast<std::int64_t>(std::floor(belt_way_m_.x() / meters_per_tick)),
          .right = static_cast<std::int64_t>(std::floor(belt_way_m_.y() / meters_per_tick))};
}

}  // namespace patrol::test
