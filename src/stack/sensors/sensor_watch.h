#pragma once

#include <array>
#include <optional>
#include <string>
#include <vector>

#include "core/frames.h"
#include "core/messages.h"
#include "core/sensors/registry.h"
#include "core/settings.h"

namespace patrol::stack {

/// When a sensor is no longer believed. Ages are counted from a message's stamp to now: a reading that comes late is as bad as none.
struct SensorWatchSettings {
  double lidar_age_s = 0.6;       ///< age limit of sensors with SensorTimeout::kLidar (core/sensors/registry.h)
  double motion_age_s = 0.15;     ///< age limit of sensors with SensorTimeout::kMotion
  double instrument_age_s = 5.0;  ///< age limit of sensors with SensorTimeout::kInstrument
  double future_s = 0.05;         ///< a stamp that far ahead of now: the sensor's clock is wrong
  double frozen_path_m = 0.1;     ///< readings that stay alike to the last bit while the robot moves so far, or turns so far
  double frozen_turn_rad = 0.1;
  int frozen_repeats = 3;      ///< and at least so often
  double give_up_s = 60.0;        ///< unable to drive for so long: the mission is over

  template <typename Self, typename Visitor>
  static void fields(Self& self, Visitor& visit) {
    visit("lidar_age_s", self.lidar_age_s, at_least(0.05));
    visit("motion_age_s", self.motion_age_s, at_least(0.01));
    visit("instrument_age_s", self.instrument_age_s, at_least(0.05));
    visit("future_s", self.future_s, at_least(0.0));
    visit("frozen_path_m", self.frozen_path_m, at_least(0.01));
    visit("frozen_turn_rad", self.frozen_turn_rad, at_least(0.01));
    visit("frozen_repeats", self.frozen_repeats, between(1, 1000));
    visit("give_up_s", self.give_up_s, at_least(1.0));
  }
};

/// A sensor began to be wrong, or came back.
struct SensorChange {
  std::string sensor;
  bool is_back = false;
  std::string text;  ///< one sentence for a person
};

/// Watches whether each sensor that was ever heard of goes on, in time, with stamps of now, and with readings that change as the robot
/// moves. What a sensor says wrongly but plausibly (a drift, a spike) it does not see.
///
/// The robot shall not drive without its lidar, which alone shows what it might run into, nor without its encoders, since an IMU alone loses
/// its place within seconds. It may without all others, IMU and foot sensors included: odometry goes on without them.
class SensorWatch {
 public:
  explicit SensorWatch(const SensorWatchSettings& settings) : settings_(settings) {}

  /// False: the message is not to be used, since its stamp lies in the future.
  bool hear(const SensorMessage& message, Time now);

  /// Once a control period. That the robot moves is known from `T_odom_body`; of the encoders, from which that comes, from the `command`
  /// since the last step.
  std::vector<SensorChange> step(Time now, const Pose2& T_odom_body, const VelocityCommand& command);

  bool can_drive() const { return !halted_since_; }
  /// Unable to drive for longer than a mission can wait.
  bool has_given_up(Time now) const { return halted_since_ && now - *halted_since_ > from_seconds(settings_.give_up_s); }

 private:
  enum class State { kFine, kSilent, kWrongClock, kFrozen };

  /// One kind of sensor message.
  struct Sensor {
    Time stamp{};  ///< of the newest message; zero: never heard of
    SensorMessage reading;
    bool is_ahead = false;     ///< the newest message came from the future
    int num_repeats = 0;       ///< of the newest reading
    bool has_changed = true;   ///< since what follows was taken
    Pose2 T_odom_changed;      ///< the body when the reading last changed
    double commanded_m = 0.0;  ///< and what was commanded from then on
    double commanded_rad = 0.0;
    State state = State::kFine;
  };

  State state_of(std::size_t kind, const Sensor& sensor, Time now, const Pose2& T_odom_body) const;
  bool is_frozen(std::size_t kind, const Sensor& sensor, const Pose2& T_odom_body) const;
  double age_limit_s(std::size_t kind) const;

  SensorWatchSettings settings_;
  std::array<Sensor, std::variant_size_v<SensorMessage>> sensors_;
  std::optional<Time> last_step_;
  std::optional<Time> halted_since_;
};

}  // namespace patrol::stack
