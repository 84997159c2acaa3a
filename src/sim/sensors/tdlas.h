#pragma once

#include <cstdint>

#include "core/messages.h"
#include "core/random.h"
#include "core/settings.h"
#include "sim/gas_plume.h"
#include "sim/lidar_scene.h"

namespace patrol::sim {

/// An open-path laser methane meter that looks along its x axis. Defaults after the data sheet of Tokyo Gas Engineering's
/// LaserMethane mini: 1-50,000 ppm m, +-10 %, 10 Hz, 30 m.
struct TdlasSettings {
  bool enabled = true;
  double rate_hz = 10.0;
  double noise_ppm_m = 10.0;        ///< standard deviation, of any reading
  double relative_noise = 0.05;     ///< standard deviation, of the column
  double background_ppm = 1.9;      ///< methane in clean air
  double resolution_ppm_m = 1.0;
  double max_column_ppm_m = 50000.0;
  double range_m = 30.0;
  double latency_s = 0.1;

  template <typename Self, typename Visitor>
  static void fields(Self& self, Visitor& visit) {
    visit("enabled", self.enabled);
    visit("rate_hz", self.rate_hz, between(0.1, 100.0));
    visit("noise_ppm_m", self.noise_ppm_m, at_least(0.0));
    visit("relative_noise", self.relative_noise, between(0.0, 1.0));
    visit("background_ppm", self.background_ppm, at_least(0.0));
    visit("resolution_ppm_m", self.resolution_ppm_m, at_least(0.0));
    visit("max_column_ppm_m", self.max_column_ppm_m, at_least(1.0));
    visit("range_m", self.range_m, between(0.1, 200.0));
    visit("latency_s", self.latency_s, between(0.0, 10.0));
  }
};

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
