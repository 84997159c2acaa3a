#pragma once

#include <cstdint>

#include "core/random.h"
#include "core/sensors/registry.h"
#include "core/settings.h"
#include "sim/gas_plume.h"
#include "sim/lidar_scene.h"

namespace patrol::sim {

class Tdlas {
 public:
  Tdlas(const TdlasSettings& settings, std::uint64_t seed);

  GasReading read(const LidarScene& scene, const GasPlume& plume, const Pose3& T_world_tdlas, Time now,
                  std::uint64_t tick) const;

 private:
  TdlasSettings settings_;
  RandomStream noise_, relative_noise_;
};

}  // namespace patrol::sim
