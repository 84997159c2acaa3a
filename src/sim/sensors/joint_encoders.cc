#include "sim/sensors/joint_encoders.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include "core/error.h"
#include "sim/sensors/sensor.h"

namespace patrol::sim {

JointEncoders::JointEncoders(const JointEncoderSettings& settings, const mjModel& model,
                             const std::vector<std::string>& joint_names, JointErrors errors)
    : errors_(std::move(errors)),
      step_rad_(2.0 * std::numbers::pi / settings.counts_per_revolution),
      tick_s_(model.opt.timestep),
      filter_gain_(tick_s_ / (settings.velocity_filter_time_constant_s + tick_s_)) {
  validate(settings, "sensors.joint_encoders");
  for (const std::string& name : joint_names) {
    const int joint = mj_name2id(&model, mjOBJ_JOINT, name.c_str());
    if (joint < 0) throw InputError("robot model: joint not found: " + name);
    qpos_.push_back(model.jnt_qposadr[joint]);
    dof_.push_back(model.jnt_dofadr[joint]);
  }
}

JointState JointEncoders::read(const mjData& data, Time now) {
  const bool is_first = last_.position_rad.empty();
  if (is_first) {
    last_.velocity_radps.assign(qpos_.size(), 0.0);
    last_.effort_nm.assign(qpos_.size(), 0.0);
    last_.position_rad.assign(qpos_.size(), 0.0);
  }
  last_.stamp = now;
  for (std::size_t joint = 0; joint < qpos_.size(); ++joint) {
    const double angle = step_rad_ * std::round((data.qpos[qpos_[joint]] + error_rad(joint, data)) / step_rad_);
    const double speed = is_first ? 0.0 : (angle - last_.position_rad[joint]) / tick_s_;
    last_.position_rad[joint] = angle;
    last_.velocity_radps[joint] += filter_gain_ * (speed - last_.velocity_radps[joint]);
    last_.effort_nm[joint] = data.qfrc_actuator[dof_[joint]];
  }
  return last_;
}

/// The motor leads the joint in the direction of its torque by half the play; a small torque leaves it in between.
double JointEncoders::error_rad(std::size_t joint, const mjData& data) const {
  if (errors_.zero_offset_rad.empty()) return 0.0;
  constexpr double kContactTorque_nm = 0.5;  // torque at which the teeth are in contact (assumption)
  const double load = std::clamp(data.qfrc_actuator[dof_[joint]] / kContactTorque_nm, -1.0, 1.0);
  return errors_.zero_offset_rad[joint] + 0.5 * errors_.play_rad[joint] * load;
}

namespace {

class EncodersOnLegs : public Sensor {
 public:
  explicit EncodersOnLegs(const SensorContext& context)
      : is_enabled_(context.settings.joint_encoders.enabled && is_fitted<JointState>(context.robot)),
        schedule_(context.settings.joint_encoders.rate_hz),
        encoders_(context.settings.joint_encoders, context.physics, context.robot.joint_names,
                  context.as_built.joints()) {}

  void step(const SensorTick& tick, std::vector<SensorMessage>& readings) override {
    tick.newest.joints = encoders_.read(tick.data, tick.now);
    if (is_enabled_ && schedule_.is_due(tick.now)) readings.emplace_back(tick.newest.joints);
  }

  void serialize_state(StateArchive& archive) override { archive(schedule_, encoders_); }

 private:
  bool is_enabled_;
  SensorSchedule schedule_;
  JointEncoders encoders_;
};

}  // namespace

template <>
std::unique_ptr<Sensor> make_sensor<JointState>(const SensorContext& context) {
  return std::make_unique<EncodersOnLegs>(context);
}

}  // namespace patrol::sim
