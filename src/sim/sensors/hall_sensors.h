#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include <mujoco/mujoco.h>

#include "core/random.h"
#include "core/sensors/registry.h"
#include "core/settings.h"

namespace patrol::sim {

/// Hall counters of both sprockets. A missed edge is never recovered, because the firmware has no other counter.
class HallSensors {
 public:
  /// `sprocket_joints`: left, right. Throws InputError when the model has no such joint.
  HallSensors(const HallSettings& settings, const mjModel& model, const std::vector<std::string>& sprocket_joints,
              std::uint64_t seed);

  /// Takes the reading of one tick. Call at every tick.
  TrackTicks read(const mjData& data, Time now);

  template <typename Archive>
  void serialize_state(Archive& archive) {
    archive(counters_);
  }

 private:
  struct Counter {
    int qpos = 0;
    std::int64_t edge = 0;     ///< last edge that passed
    std::int64_t count = 0;    ///< counter value
    std::uint64_t passed = 0;  ///< passed edges in both directions; index of the next random number
  };
  std::int64_t advance(Counter& counter, std::uint64_t side, double angle_rad);

  HallSettings settings_;
  RandomStream missed_;
  std::array<Counter, 2> counters_;  ///< left, right
};

}  // namespace patrol::sim
