#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include <mujoco/mujoco.h>

#include "core/random.h"
#include "core/robot_description.h"
#include "core/sensors/registry.h"
#include "core/settings.h"

namespace patrol::sim {

class FootContactSensor {
 public:
  FootContactSensor(const FootContactSettings& settings, const mjModel& model, const std::vector<LegGeometry>& legs,
                    std::uint64_t seed);

  FootContacts read(const mjModel& model, const mjData& data, Time now, std::uint64_t tick) const;

 private:
  FootContactSettings settings_;
  std::vector<int> foot_geoms_;   ///< foot geom ids, [leg]
  std::vector<double> offset_n_;  ///< offsets, [leg]
  RandomStream noise_;
};

}  // namespace patrol::sim
