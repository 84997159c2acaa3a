#include "sim/sensors/hall_sensors.h"

#include <algorithm>
#include <cmath>

#include "core/error.h"
#include "sim/sensors/sensor.h"

namespace patrol::sim {
namespace {

int address_of(const mjModel& model, const std::string& joint_name) {
  const int joint = mj_name2id(&model, mjOBJ_JOINT, joint_name.c_str());
  if (joint < 0) throw InputError("robot model: joint not found: " + joint_name);
  return model.jnt_qposadr[joint];
}

}  // namespace

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
    if (missed_.uniform(counter.passed, side) >= settings_.missed_edge_probability) counter.count += step;
  }
  return counter.count;
}

namespace {

HallSettings with_missed_edges(HallSettings settings, const TrackErrors& errors) {
  settings.missed_edge_probability = std::min(1.0, settings.missed_edge_probability + errors.missed_edge_probability);
  return settings;
}

class HallOnMotors : public Sensor {
 public:
  explicit HallOnMotors(const SensorContext& context)
      : is_enabled_(context.settings.hall.enabled),
        schedule_(context.settings.hall.rate_hz),
        hall_(with_missed_edges(context.settings.hall, context.as_built.tracks()), context.physics,
              context.robot.joint_names, context.seed) {}

  void step(const SensorTick& tick, std::vector<SensorMessage>& readings) override {
    tick.newest.ticks = hall_.read(tick.data, tick.now);
    if (is_enabled_ && schedule_.is_due(tick.now)) readings.emplace_back(tick.newest.ticks);
  }

  void serialize_state(StateArchive& archive) override { archive(schedule_, hall_); }

 private:
  bool is_enabled_;
  SensorSchedule schedule_;
  HallSensors hall_;
};

}  // namespace

template <>
std::unique_ptr<Sensor> make_sensor<TrackTicks>(const SensorContext& context) {
  if (!is_fitted<TrackTicks>(context.robot)) return nullptr;
  return std::make_unique<HallOnMotors>(context);
}

}  // namespace patrol::sim
