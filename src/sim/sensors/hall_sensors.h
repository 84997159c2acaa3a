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
