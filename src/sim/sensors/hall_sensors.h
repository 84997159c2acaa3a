#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include <mujoco/mujoco.h>

#include "core/messages.h"
#include "core/random.h"
#include "core/settings.h"

namespace patrol::sim {

/// Hall sensors in the drive motors: they count the edges that the rotor's magnets make as they pass. Three sensors on a rotor of
/// four pole pairs, every edge counted, make 24 a revolution; the gear multiplies them. (Data sheets of flat brushless motors of
/// this class, e.g. maxon's EC flat family: 7 to 11 pole pairs and 3 sensors; ours is the coarser end.)
struct HallSettings {
  bool enabled = true;
  double rate_hz = 50.0;                ///< of the messages; the firmware reads at every tick
  int ticks_per_motor_turn = 24;
  double gear_ratio = 30.0;             ///< motor turns per turn of the sprocket
  double missed_tick_probability = 0.0; ///< of each edge, not to be counted
  double latency_s = 0.0;

  /// Counts per radian of the sprocket.
  double ticks_per_rad() const;

  template <typename Self, typename Visitor>
  static void fields(Self& self, Visitor& visit) {
    visit("enabled", self.enabled);
    visit("rate_hz", self.rate_hz, between(1.0, 500.0));
    visit("ticks_per_motor_turn", self.ticks_per_motor_turn, between(1, 10000));
    visit("gear_ratio", self.gear_ratio, between(1.0, 1000.0));
    visit("missed_tick_probability", self.missed_tick_probability, between(0.0, 1.0));
    visit("latency_s", self.latency_s, between(0.0, 10.0));
  }
};

/// Counts both sprockets' turns. An edge that is missed is missed for good: counter and firmware are one.
class HallSensors {
 public:
  /// `sprocket_joints`: left, right. Throws InputError when the model has no such joint.
  HallSensors(const HallSettings& settings, const mjModel& model, const std::vector<std::string>& sprocket_joints,
              std::uint64_t seed);

  /// One reading a tick.
  TrackTicks read(const mjData& data, Time now);

 private:
  struct Counter {
    int qpos;
    std::int64_t edge = 0;    ///< the last that passed
    std::int64_t count = 0;   ///< as counted
    std::uint64_t passed = 0; ///< edges, both ways: the address of the next draw
  };
  std::int64_t advance(Counter& counter, std::uint64_t side, double angle_rad);

  HallSettings settings_;
  RandomStream missed_;
  std::array<Counter, 2> counters_;  ///< left, right
};

}  // namespace patrol::sim
