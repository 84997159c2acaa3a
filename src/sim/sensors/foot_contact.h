#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include <mujoco/mujoco.h>

#include "core/messages.h"
#include "core/random.h"
#include "core/robot_description.h"
#include "core/settings.h"

namespace patrol::sim {

/// Force sensors in the feet: strain gauges with an offset that each foot keeps for the run.
struct FootContactSettings {
  bool enabled = true;
  double rate_hz = 250.0;      ///< of the messages; the firmware reads at every tick
  double noise_n = 1.0;        ///< standard deviation
  double offset_n = 1.0;       ///< standard deviation
  double resolution_n = 0.5;
  double range_n = 500.0;
  double latency_s = 0.0;

  template <typename Self, typename Visitor>
  static void fields(Self& self, Visitor& visit) {
    visit("enabled", self.enabled);
    visit("rate_hz", self.rate_hz, between(1.0, 500.0));
    visit("noise_n", self.noise_n, at_least(0.0));
    visit("offset_n", self.offset_n, at_least(0.0));
    visit("resolution_n", self.resolution_n, at_least(0.0));
    visit("range_n", self.range_n, at_least(1.0));
    visit("latency_s", self.latency_s, between(0.0, 10.0));
  }
};

class FootContactSensor {
 public:
  FootContactSensor(const FootContactSettings& settings, const mjModel& model, const std::vector<LegGeometry>& legs,
                    std::uint64_t seed);

  FootContacts read(const mjModel& model, const mjData& data, Time now, std::uint64_t tick) const;

 private:
  FootContactSettings settings_;
  std::vector<int> foot_geoms_;   ///< [leg]
  std::vector<double> offset_n_;  ///< [leg]
  RandomStream noise_;
};

}  // namespace patrol::sim
