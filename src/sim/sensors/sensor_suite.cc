#include "sim/sensors/sensor_suite.h"

#include <algorithm>
#include <utility>

namespace patrol::sim {
namespace {

Pose3 body_pose(const mjData& data, int body) {
  const mjtNum* q = data.xquat + 4 * body;
  return {Eigen::Vector3d(data.xpos + 3 * body), Eigen::Quaterniond(q[0], q[1], q[2], q[3])};
}

/// Completes a reading, which keeps its stamp.
void complete_reading(Sensor& sensor, SensorMessage& reading) {
  const Time stamp = std::visit([](const auto& content) { return content.stamp; }, reading);
  sensor.complete(reading);
  std::visit([stamp](auto& content) { content.stamp = stamp; }, reading);
}

}  // namespace

SensorSuite::SensorSuite(const SensorSuiteSettings& settings, const AsBuiltRobot& robot, const mjModel& physics,
                         const mjModel& view, const GasPlume& plume, const std::vector<FaultSettings>& faults,
                         std::uint64_t seed, const DepthImagerFactory& make_depth_imager, const Subsurface& subsurface,
                         bool has_thread)
    : settings_(settings),
      body_(mj_name2id(&physics, mjOBJ_BODY, frame_id::kBody)),
      scene_(view),
      worker_(has_thread),
      faults_(faults, seed) {
  validate(settings.dust, "sensors.dust");
  const SensorContext context{.settings = settings_,
                              .as_built = robot,
                              .robot = robot.actual(),
                              .physics = physics,
                              .view = view,
                              .scene = scene_,
                              .plume = plume,
                              .subsurface = subsurface,
                              .make_depth_imager = make_depth_imager,
                              .worker = worker_,
                              .seed = seed};
  for (std::size_t type = 0; type < channels_.size(); ++type) {
    const SensorInfo& info = kSensorInfos[type];
    channels_[type].clock = robot.clock(info.is_read_by_firmware ? "firmware" : info.name);
  }
  for (const bool are_read_by_firmware : {true, false}) add_sensors(context, are_read_by_firmware);
}

void SensorSuite::add_sensors(const SensorContext& context, bool are_read_by_firmware) {
  Sensors::for_each([&]<typename Message>(std::type_identity<Message>) {
    if (SensorTraits<Message>::kInfo.is_read_by_firmware != are_read_by_firmware) return;
    std::unique_ptr<Sensor> sensor = make_sensor<Message>(context);
    if (sensor) sensors_.push_back({latency_s<Message>(settings_), std::move(sensor)});
  });
}

void SensorSuite::step(const mjModel& physics, mjData& data, Time now) {
  const Pose3 T_world_body = body_pose(data, body_);
  {
    const auto timer = clock_.time_stage("lidar");
    scene_.update(data);
  }
  const BodyState last = last_body_.value_or(BodyState{now, T_world_body});
  const SensorTick tick{.physics = physics,
                        .data = data,
                        .count = tick_++,
                        .now = now,
                        .T_world_body = T_world_body,
                        .last = last.time,
                        .T_world_body_last = last.T_world_body,
                        .newest = newest_,
                        .clock = clock_};
  for (Entry& entry : sensors_) step_sensor(entry, tick);
  last_body_ = {now, T_world_body};
}

void SensorSuite::step_sensor(Entry& entry, const SensorTick& tick) {
  readings_.clear();
  entry.sensor->step(tick, readings_);
  for (SensorMessage& reading : readings_) deliver(tick.now, entry.latency_s, std::move(reading), entry.sensor.get());
}

void SensorSuite::command(const InstrumentCommand& command) {
  if (!last_body_) return;
  for (Entry& entry : sensors_) entry.sensor->command(command, last_body_->time, last_body_->T_world_body);
}

bool SensorSuite::is_busy() const {
  return std::any_of(sensors_.begin(), sensors_.end(), [](const Entry& entry) { return entry.sensor->is_busy(); });
}

void SensorSuite::deliver(Time ready, double latency_s, SensorMessage message, Sensor* incomplete) {
  Channel& channel = channels_[message.index()];
  std::visit([&](auto& content) { content.stamp = channel.clock.stamp(content.stamp); }, message);
  const Time delay = channel.clock.transport_delay(channel.num_messages++);
  Time due = std::max(channel.last_due, ready + from_seconds(latency_s) + delay);
  channel.last_due = due;
  if (incomplete && !faults_.reports().empty()) complete_reading(*std::exchange(incomplete, nullptr), message);
  if (faults_.apply(ready, due, message)) queue_.push(due, {std::move(message), incomplete});
}

std::vector<SensorMessage> SensorSuite::take_due(Time now) {
  std::vector<SensorMessage> due;
  for (QueuedMessage& queued : queue_.take_due(now)) {
    complete(queued);
    due.push_back(std::move(queued.message));
  }
  return due;
}

void SensorSuite::complete(QueuedMessage& queued) {
  if (!queued.incomplete) return;
  complete_reading(*std::exchange(queued.incomplete, nullptr), queued.message);
  faults_.remember(queued.message);
}

}  // namespace patrol::sim
