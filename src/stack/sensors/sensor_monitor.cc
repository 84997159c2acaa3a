#include "stack/sensors/sensor_monitor.h"

#include <algorithm>
#include <cmath>
#include <utility>
#include <variant>

#include <fmt/format.h>

namespace patrol::stack {
namespace {

/// Returns whether the message repeats the reading of `before`, which is of the same sensor.
bool repeats_reading(const SensorMessage& message, const SensorMessage& before) {
  const auto repeats_before = [&]<typename Message>(const Message& now) {
    return repeats(now, std::get<Message>(before));
  };
  return std::visit(repeats_before, message);
}

}  // namespace

bool SensorMonitor::receive(const SensorMessage& message, Time received) {
  const std::size_t kind = message.index();
  Sensor& sensor = sensors_[kind];
  sensor.stamp = stamp_of(message);
  const double lead_s = to_seconds(sensor.stamp - received);
  sensor.has_future_stamp = lead_s > sensor.clock_lead_s + settings_.max_clock_lead_s;
  if (!sensor.has_future_stamp) follow_clock(lead_s, received, sensor);
  sensor.received = received;
  if (kSensorInfos[kind].freeze_check == FreezeCheck::kNone || sensor.has_future_stamp) return !sensor.has_future_stamp;
  const bool has_reading = sensor.reading.index() == kind;  // initially a laser scan without returns, which no scan
                                                            // repeats
  if (has_reading && repeats_reading(message, sensor.reading)) {
    ++sensor.num_repeats;
    return true;
  }
  sensor.reading = message;
  sensor.num_repeats = 0;
  sensor.has_changed = true;
  return true;
}

void SensorMonitor::follow_clock(double lead_s, Time now, Sensor& sensor) const {
  if (sensor.received == Time{}) return;
  const double max_change_s = settings_.max_clock_drift * to_seconds(now - sensor.received);
  sensor.clock_lead_s += std::clamp(lead_s - sensor.clock_lead_s, -max_change_s, max_change_s);
}

std::vector<SensorChange> SensorMonitor::step(Time now, const Pose2& T_odom_body, const VelocityCommand& command,
                                              const std::optional<LidarClock>& lidar_clock) {
  const double period_s = last_step_ ? to_seconds(now - *last_step_) : 0.0;
  last_step_ = now;
  std::vector<SensorChange> changes;
  bool can_drive = true;
  for (std::size_t kind = 0; kind < sensors_.size(); ++kind) {
    Sensor& sensor = sensors_[kind];
    const SensorInfo& info = kSensorInfos[kind];
    if (sensor.stamp == Time{} || info.timeout == SensorTimeout::kNone) continue;
    if (std::exchange(sensor.has_changed, false)) {
      sensor.T_odom_changed = T_odom_body;
      sensor.commanded_m = sensor.commanded_rad = 0.0;
    }
    sensor.commanded_m += std::hypot(command.vx_mps, command.vy_mps) * period_s;
    sensor.commanded_rad += std::abs(command.yaw_rate_radps) * period_s;
    const State state = state_of(kind, sensor, now, T_odom_body);
    if (info.is_required_to_drive && state != State::kFine) can_drive = false;
    if (std::exchange(sensor.state, state) == state) continue;
    const auto add = [&](const char* what) {
      changes.push_back({.sensor = info.name,
                         .has_recovered = state == State::kFine,
                         .text = fmt::format("Sensor {} {}.", info.name, what)});
    };
    switch (state) {
      case State::kFine:
        add("has recovered");
        break;
      case State::kTimedOut:
        add("timed out");
        break;
      case State::kWrongClock:
        add("has timestamps in the future");
        break;
      case State::kFrozen:
        add("is frozen (repeated readings)");
        break;
    }
  }
  if (lidar_clock) {
    if (std::optional<SensorChange> change = clock_monitor_.step(now, *lidar_clock)) changes.push_back(*change);
    can_drive = can_drive && clock_monitor_.can_drive();
  }
  if (can_drive) halted_since_.reset();
  else if (!halted_since_) halted_since_ = now;
  return changes;
}

SensorMonitor::State SensorMonitor::state_of(std::size_t kind, const Sensor& sensor, Time now,
                                             const Pose2& T_odom_body) const {
  if (sensor.has_future_stamp) return State::kWrongClock;
  const Time age = now - sensor.stamp + from_seconds(sensor.clock_lead_s);
  if (age > from_seconds(timeout_s(kind))) return State::kTimedOut;
  return is_frozen(kind, sensor, T_odom_body) ? State::kFrozen : State::kFine;
}

bool SensorMonitor::is_frozen(std::size_t kind, const Sensor& sensor, const Pose2& T_odom_body) const {
  if (sensor.num_repeats < settings_.frozen_repeats) return false;
  if (sensor.state == State::kFrozen) return true;  // a robot that has stopped for this fault does not move
  const Pose2 moved = sensor.T_odom_changed.inverse() * T_odom_body;
  const bool is_by_command = kSensorInfos[kind].freeze_check == FreezeCheck::kCommand;
  const double path_m = is_by_command ? sensor.commanded_m : moved.position().norm();
  const double turn_rad = is_by_command ? sensor.commanded_rad : std::abs(moved.yaw);
  return path_m > settings_.frozen_path_m || turn_rad > settings_.frozen_turn_rad;
}

double SensorMonitor::timeout_s(std::size_t kind) const {
  switch (kSensorInfos[kind].timeout) {
    case SensorTimeout::kLidar:
      return settings_.lidar_timeout_s;
    case SensorTimeout::kMotion:
      return settings_.proprioception_timeout_s;
    default:
      return settings_.instrument_timeout_s;
  }
}

}  // namespace patrol::stack
