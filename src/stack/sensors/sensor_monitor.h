#pragma once

#include <array>
#include <optional>
#include <vector>

#include "core/frames.h"
#include "core/messages.h"
#include "core/sensors/registry.h"
#include "core/settings.h"
#include "stack/sensors/clock_monitor.h"
#include "stack/sensors/sensor_change.h"
#include "stack/sensors/sensor_monitor_settings.h"

namespace patrol::stack {

/// Sensor monitor.
///
/// Checks for each sensor that has ever published: messages arrive in time, stamps agree with the clock, readings
/// change as the robot moves. Plausible errors (drift, outliers) are not detected. The clock of the lidar is also
/// compared with odometry (clock_monitor.h), if its offset is estimated.
///
/// The robot must not drive without its lidar, the only sensor of obstacles ahead. It must not drive without its
/// encoders either, since the IMU alone loses the pose within seconds. It can drive without all others, including IMU
/// and foot sensors, because odometry continues without them.
class SensorMonitor {
 public:
  explicit SensorMonitor(const SensorMonitorSettings& settings)
      : settings_(settings), clock_monitor_(settings.lidar_clock) {}

  /// Processes a message that arrived at `received`. Returns false if it must not be used, because its stamp is in the
  /// future.
  bool receive(const SensorMessage& message, Time received);

  /// Returns the changes since the last step. Call once per control period. The reference motion is `T_odom_body`; for
  /// the encoders, from which odometry is computed, it is the `command` since the last step. `lidar_clock`: none if the
  /// time offset of the lidar is not estimated.
  std::vector<SensorChange> step(Time now, const Pose2& T_odom_body, const VelocityCommand& command,
                                 const std::optional<LidarClock>& lidar_clock = std::nullopt);

  bool can_drive() const { return !halted_since_; }
  /// Returns whether the robot has been unable to drive for longer than `abort_timeout_s`.
  bool must_abort(Time now) const {
    return halted_since_ && now - *halted_since_ > from_seconds(settings_.abort_timeout_s);
  }

  template <typename Archive>
  void serialize_state(Archive& archive) {
    archive(clock_monitor_, sensors_, last_step_, halted_since_);
  }

 private:
  enum class State { kFine, kTimedOut, kWrongClock, kFrozen };

  /// State of one type of sensor message.
  struct Sensor {
    Time stamp{};  ///< stamp of the newest message; zero: none received yet
    SensorMessage reading;
    Time received{};                ///< time of the newest message; zero: none received yet
    double clock_lead_s = 0.0;      ///< slow drift of the stamps ahead of the time of their receipt
    bool has_future_stamp = false;  ///< true: the newest message has a stamp in the future
    int num_repeats = 0;            ///< repetitions of the newest reading
    bool has_changed = true;        ///< true: the reading has changed since the reference below was taken
    Pose2 T_odom_changed;           ///< body pose when the reading last changed
    double commanded_m = 0.0;       ///< commanded distance since then
    double commanded_rad = 0.0;
    State state = State::kFine;
  };

  /// Follows a lead of the stamps at no more than the drift of a clock.
  void follow_clock(double lead_s, Time now, Sensor& sensor) const;
  State state_of(std::size_t kind, const Sensor& sensor, Time now, const Pose2& T_odom_body) const;
  bool is_frozen(std::size_t kind, const Sensor& sensor, const Pose2& T_odom_body) const;
  double timeout_s(std::size_t kind) const;

  SensorMonitorSettings settings_;
  ClockMonitor clock_monitor_;
  std::array<Sensor, std::variant_size_v<SensorMessage>> sensors_;
  std::optional<Time> last_step_;
  std::optional<Time> halted_since_;
};

}  // namespace patrol::stack
