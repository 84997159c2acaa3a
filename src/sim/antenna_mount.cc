#include "sim/antenna_mount.h"

#include <algorithm>
#include <cmath>
#include <string>

#include "core/error.h"
#include "core/geometry/angles.h"

namespace patrol::sim {
namespace {

constexpr std::array kJointNames = {"tem_yaw_joint", "tem_pitch_joint"};

int joint_id(const mjModel& physics, const char* name) {
  const int joint = mj_name2id(&physics, mjOBJ_JOINT, name);
  if (joint < 0) throw InputError(std::string("robot model: joint not found: ") + name);
  return joint;
}

/// Returns the speed from which a servo can stop within `distance_rad`.
double braking_speed(double distance_rad, double acceleration_radps2) {
  return std::copysign(std::sqrt(2.0 * acceleration_radps2 * std::abs(distance_rad)), distance_rad);
}

}  // namespace

AntennaMount::AntennaMount(const AntennaSettings& settings, const AntennaGeometry& mount, const mjModel& physics,
                           std::uint64_t seed)
    : settings_(settings) {
  validate(settings, "sensors.antenna");
  const RandomStream alignment(seed, "antenna/alignment");
  for (std::size_t i = 0; i < servos_.size(); ++i) {
    const int joint = joint_id(physics, kJointNames[i]);
    const double stowed_rad = i == 0 ? mount.stowed_yaw_rad : mount.stowed_pitch_rad;
    servos_[i] = {.qpos = physics.jnt_qposadr[joint],
                  .dof = physics.jnt_dofadr[joint],
                  .motor = mj_name2id(&physics, mjOBJ_ACTUATOR, kJointNames[i]),
                  .limit = i == 0 ? mount.yaw : mount.pitch,
                  .stowed_rad = stowed_rad,
                  .alignment_rad = settings.alignment_std_deg * kDegree * alignment.normal(i),
                  .target_rad = stowed_rad,
                  .setpoint_rad = stowed_rad};
  }
}

void AntennaMount::command(const AntennaCommand& command) {
  const std::array<double, 2> wanted_rad = {command.yaw_rad, command.pitch_rad};
  for (std::size_t i = 0; i < servos_.size(); ++i) {
    servos_[i].target_rad = std::clamp(wanted_rad[i], servos_[i].limit.lower_rad, servos_[i].limit.upper_rad);
  }
}

double AntennaMount::encoder_rad(const Servo& servo, const mjData& data) const {
  const double angle_rad = data.qpos[servo.qpos] + servo.alignment_rad + servo.backlash_rad;
  const double step_rad = settings_.resolution_deg * kDegree;
  return step_rad > 0.0 ? step_rad * std::round(angle_rad / step_rad) : angle_rad;
}

void AntennaMount::step(const mjModel& physics, mjData& data) {
  const double tick_s = physics.opt.timestep;
  for (Servo& servo : servos_) {
    const double distance_rad = servo.target_rad - servo.setpoint_rad;
    const double limit_radps =
        std::min(settings_.max_speed_radps, std::abs(braking_speed(distance_rad, settings_.max_acceleration_radps2)));
    const double max_change_radps = settings_.max_acceleration_radps2 * tick_s;
    const double wanted_radps = std::clamp(distance_rad / tick_s, -limit_radps, limit_radps);
    servo.speed_radps =
        std::clamp(wanted_radps, servo.speed_radps - max_change_radps, servo.speed_radps + max_change_radps);
    if (std::abs(distance_rad) <= std::abs(servo.speed_radps) * tick_s) servo.speed_radps = distance_rad / tick_s;
    servo.setpoint_rad += servo.speed_radps * tick_s;
    if (servo.speed_radps != 0.0)
      servo.backlash_rad = std::copysign(settings_.backlash_deg / 2.0 * kDegree, servo.speed_radps);

    const double error_rad = servo.setpoint_rad - encoder_rad(servo, data);
    const bool is_within_dead_band =
        servo.speed_radps == 0.0 && std::abs(error_rad) < settings_.dead_band_deg * kDegree;
    const double spring_nm = is_within_dead_band ? 0.0 : settings_.stiffness_nm_per_rad * error_rad;
    const double torque_nm = spring_nm + settings_.damping_nms_per_rad * (servo.speed_radps - data.qvel[servo.dof]);
    data.ctrl[servo.motor] = std::clamp(torque_nm, -servo.limit.effort_nm, servo.limit.effort_nm);
  }
}

std::optional<AntennaState> AntennaMount::read(const mjData& data, Time now) {
  if (now < from_seconds(static_cast<double>(count_) / settings_.rate_hz)) return std::nullopt;
  ++count_;
  return AntennaState{
      .stamp = now, .yaw_rad = encoder_rad(servos_[0], data), .pitch_rad = encoder_rad(servos_[1], data)};
}

bool AntennaMount::is_deployed(const mjData& data) const {
  constexpr double kStowed_rad = 3.0 * kDegree;
  return std::any_of(servos_.begin(), servos_.end(), [&](const Servo& servo) {
    return std::abs(encoder_rad(servo, data) - servo.stowed_rad) > kStowed_rad;
  });
}

void stow_antenna(const mjModel& model, mjtNum* qpos) {
  const AntennaGeometry mount;
  const std::array<double, 2> stowed_rad = {mount.stowed_yaw_rad, mount.stowed_pitch_rad};
  for (std::size_t i = 0; i < kJointNames.size(); ++i) {
    const int joint = mj_name2id(&model, mjOBJ_JOINT, kJointNames[i]);
    if (joint >= 0) qpos[model.jnt_qposadr[joint]] = stowed_rad[i];
  }
}

}  // namespace patrol::sim
