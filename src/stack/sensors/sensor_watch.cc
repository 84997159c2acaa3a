#include "stack/sensors/sensor_watch.h"

#include <cmath>
#include <type_traits>
#include <utility>
#include <variant>

#include <fmt/format.h>

namespace patrol::stack {
namespace {

enum class Pace { kLidar, kMotion, kInstrument, kUnwatched };
enum class Freezes { kNot, kByOdometry, kByCommand };  ///< by what the robot is known to move

struct Watched {
  const char* name;
  Pace pace;
  Freezes freezes;
  bool is_needed;     ///< to drive
};

/// In the order of SensorMessage.
constexpr std::array<Watched, std::variant_size_v<SensorMessage>> kWatched = {
    {{"lidar", Pace::kLidar, Freezes::kByOdometry, true},
     {"lidar3d", Pace::kLidar, Freezes::kNot, false},
     {"imu", Pace::kMotion, Freezes::kByOdometry, false},
     {"joint_encoders", Pace::kMotion, Freezes::kByCommand, true},
     {"foot_contact", Pace::kMotion, Freezes::kByCommand, false},
     {"tdlas", Pace::kInstrument, Freezes::kNot, false},
     {"gnss", Pace::kInstrument, Freezes::kNot, false},
     {"hall", Pace::kMotion, Freezes::kByCommand, true},
     {"uwb", Pace::kInstrument, Freezes::kNot, false},
     {"ultrasonic", Pace::kInstrument, Freezes::kNot, false},
     {"depth_camera", Pace::kLidar, Freezes::kNot, false},
     {"remote", Pace::kUnwatched, Freezes::kNot, false},   // a person may let go of it
     {"scanner", Pace::kUnwatched, Freezes::kNot, false},  // speaks when asked
     {"antenna", Pace::kUnwatched, Freezes::kNot, false},
     {"tem", Pace::kUnwatched, Freezes::kNot, false}}};
static_assert(std::is_same_v<SensorMessage, std::variant<LaserScan, PointCloud, Imu, JointState, FootContacts, GasReading, GnssFix, TrackTicks, UwbRange,
                                                         UltrasonicRange, DepthImage, RemoteCommand, PanoramicScan, AntennaState, TemSounding>>);

/// Whether a reading says the same as the one before, to the last bit; only of sensors whose readings cannot, while the robot moves.
struct Repeats {
  const SensorMessage& before;

  bool operator()(const LaserScan& now) const {
    const auto& ranges = std::get<LaserScan>(before).ranges_m;
    bool has_return = false;
    for (std::size_t i = 0; i < now.ranges_m.size() && i < ranges.size(); ++i) {
      if (!std::isfinite(now.ranges_m[i]) && !std::isfinite(ranges[i])) continue;
      has_return = true;
      if (now.ranges_m[i] != ranges[i]) return false;
    }
    return has_return;  // in an empty field all scans are alike
  }
  bool operator()(const Imu& now) const {
    const Imu& imu = std::get<Imu>(before);
    return now.angular_velocity_radps == imu.angular_velocity_radps && now.linear_acceleration_mps2 == imu.linear_acceleration_mps2;
  }
  bool operator()(const JointState& now) const { return now.position_rad == std::get<JointState>(before).position_rad; }
  bool operator()(const FootContacts& now) const { return now.force_n == std::get<FootContacts>(before).force_n; }
  bool operator()(const TrackTicks& now) const {
    const TrackTicks& ticks = std::get<TrackTicks>(before);
    return now.left == ticks.left && now.right == ticks.right;
  }
  bool operator()(const auto&) const { return false; }
};

}  // namespace

bool SensorWatch::hear(const SensorMessage& message, Time now) {
  const std::size_t kind = message.index();
  Sensor& sensor = sensors_[kind];
  sensor.stamp = std::visit([](const auto& reading) { return reading.stamp; }, message);
  sensor.is_ahead = sensor.stamp > now + from_seconds(settings_.future_s);
  if (kWatched[kind].freezes == Freezes::kNot || sensor.is_ahead) return !sensor.is_ahead;
  const bool has_reading = sensor.reading.index() == kind;  // a laser scan that was never heard has no returns, and is repeated by none
  if (has_reading && std::visit(Repeats{sensor.reading}, message)) {
    ++sensor.num_repeats;
    return true;
  }
  sensor.reading = message;
  sensor.num_repeats = 0;
  sensor.has_changed = true;
  return true;
}

std::vector<SensorChange> SensorWatch::step(Time now, const Pose2& T_odom_body, const VelocityCommand& command) {
  const double period_s = last_step_ ? to_seconds(now - *last_step_) : 0.0;
  last_step_ = now;
  std::vector<SensorChange> changes;
  bool can_drive = true;
  for (std::size_t kind = 0; kind < sensors_.size(); ++kind) {
    Sensor& sensor = sensors_[kind];
    const Watched& watched = kWatched[kind];
    if (sensor.stamp == Time{} || watched.pace == Pace::kUnwatched) continue;
    if (std::exchange(sensor.has_changed, false)) {
      sensor.T_odom_changed = T_odom_body;
      sensor.commanded_m = sensor.commanded_rad = 0.0;
    }
    sensor.commanded_m += std::hypot(command.vx_mps, command.vy_mps) * period_s;
    sensor.commanded_rad += std::abs(command.yaw_rate_radps) * period_s;
    const State state = state_of(kind, sensor, now, T_odom_body);
    if (watched.is_needed && state != State::kFine) can_drive = false;
    if (std::exchange(sensor.state, state) == state) continue;
    const auto add = [&](const char* what) {
      changes.push_back({.sensor = watched.name, .is_back = state == State::kFine, .text = fmt::format("The {} {}.", watched.name, what)});
    };
    switch (state) {
      case State::kFine: add("is back"); break;
      case State::kSilent: add("is silent or late"); break;
      case State::kWrongClock: add("has a wrong clock"); break;
      case State::kFrozen: add("repeats itself"); break;
    }
  }
  if (can_drive) halted_since_.reset();
  else if (!halted_since_) halted_since_ = now;
  return changes;
}

SensorWatch::State SensorWatch::state_of(std::size_t kind, const Sensor& sensor, Time now, const Pose2& T_odom_body) const {
  if (sensor.is_ahead) return State::kWrongClock;
  if (now - sensor.stamp > from_seconds(age_limit_s(kind))) return State::kSilent;
  return is_frozen(kind, sensor, T_odom_body) ? State::kFrozen : State::kFine;
}

bool SensorWatch::is_frozen(std::size_t kind, const Sensor& sensor, const Pose2& T_odom_body) const {
  if (sensor.num_repeats < settings_.frozen_repeats) return false;
  if (sensor.state == State::kFrozen) return true;  // a robot that was halted for it does not move
  const Pose2 moved = sensor.T_odom_changed.inverse() * T_odom_body;
  const bool is_by_command = kWatched[kind].freezes == Freezes::kByCommand;
  const double path_m = is_by_command ? sensor.commanded_m : moved.position().norm();
  const double turn_rad = is_by_command ? sensor.commanded_rad : std::abs(moved.yaw);
  return path_m > settings_.frozen_path_m || turn_rad > settings_.frozen_turn_rad;
}

double SensorWatch::age_limit_s(std::size_t kind) const {
  switch (kWatched[kind].pace) {
    case Pace::kLidar: return settings_.lidar_age_s;
    case Pace::kMotion: return settings_.motion_age_s;
    default: return settings_.instrument_age_s;
  }
}

}  // namespace patrol::stack
