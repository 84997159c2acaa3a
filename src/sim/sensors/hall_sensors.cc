#include "sim/sensors/hall_sensors.h"

#include <cmath>
#include <numbers>

#include "core/error.h"

namespace patrol::sim {
namespace {

int address_of(const mjModel& model, const std::string& joint_name) {
  const int joint = mj_name2id(&model, mjOBJ_JOINT, joint_name.c_str());
  if (joint < 0) throw InputError("the robot's model has no joint " + joint_name);
  return model.jnt_qposadr[joint];
}

}  // namespace

double HallSettings::ticks_per_rad() const { return ticks_per_motor_turn * gear_ratio / (2.0 * std::numbers::pi); }

HallSensors::HallSensors(const HallSettings& settings, const mjModel& model,
                         const std::vector<std::string>& sprocket_joints, std::uint64_t seed)
    : settings_(settings), missed_(seed, "hall/missed") {
  validate(settings, "sensors.hall");
  for (std::size_t side = 0; side < counters_.size(); ++side) {
    counters_[side] = {.qpos = address_of(model, sprocket_joints.at(side))};
  }
}

TrackTicks HallSensors::read(const mjData& data, Time now) {
  return {.stamp = now,
          .left = advance(counters_[0], 0, data.qpos[counters_[0].qpos]),
          .right = advance(counters_[1], 1, data.qpos[counters_[1].qpos])};
}

std::int64_t HallSensors::advance(Counter& counter, std::uint64_t side, double angle_rad) {
  const auto edge = static_cast<std::int64_t>(std::floor(angle_rad * settings_.ticks_per_rad()));
  const std::int64_t step = edge > counter.edge ? 1 : -1;
  for (; counter.edge != edge; counter.edge += step, ++counter.passed) {
    if (missed_.uniform(counter.passed, side) >= settings_.missed_tick_probability) counter.count += step;
  }
  return counter.count;
}

}  // namespace patrol::sim
