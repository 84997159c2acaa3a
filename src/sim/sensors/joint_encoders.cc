#include "sim/sensors/joint_encoders.h"

#include <cmath>
#include <numbers>

#include "core/error.h"

namespace patrol::sim {

JointEncoders::JointEncoders(const JointEncoderSettings& settings, const mjModel& model,
                             const std::vector<std::string>& joint_names)
    : step_rad_(2.0 * std::numbers::pi / settings.counts_per_turn),
      tick_s_(model.opt.timestep),
      blend_(tick_s_ / (settings.speed_filter_s + tick_s_)) {
  validate(settings, "sensors.joint_encoders");
  for (const std::string& name : joint_names) {
    const int joint = mj_name2id(&model, mjOBJ_JOINT, name.c_str());
    if (joint < 0) throw InputError("the robot's model has no joint " + name);
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
    const double angle = step_rad_ * std::round(data.qpos[qpos_[joint]] / step_rad_);
    const double speed = is_first ? 0.0 : (angle - last_.position_rad[joint]) / tick_s_;
    last_.position_rad[joint] = angle;
    last_.velocity_radps[joint] += blend_ * (speed - last_.velocity_radps[joint]);
    last_.effort_nm[joint] = data.qfrc_actuator[dof_[joint]];
  }
  return last_;
}

}  // namespace patrol::sim
