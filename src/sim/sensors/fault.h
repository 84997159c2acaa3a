#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "core/sensors/registry.h"
#include "core/settings.h"
#include "core/time.h"

namespace patrol::sim {

/// Temporary fault of a sensor.
struct FaultSettings {
  std::string sensor = "lidar";
  std::string kind = "dropout";
  double start_s = 0.0;
  double duration_s = 1.0;
  /// Magnitude of the fault. delay: s; jitter: standard deviation of a random delay per message, s; clock_offset: s
  /// added to the stamps; drift: units of the sensor per s; outliers: units of the sensor; dropout, freeze: unused.
  double magnitude = 1.0;

  template <typename Self, typename Visitor>
  static void fields(Self& self, Visitor& visit) {
    visit("sensor", self.sensor, one_of(sensor_names()));
    visit("kind", self.kind, one_of({"dropout", "freeze", "delay", "jitter", "clock_offset", "drift", "outliers"}));
    visit("start_s", self.start_s, at_least(0.0));
    visit("duration_s", self.duration_s, at_least(0.0));
    visit("magnitude", self.magnitude);
  }

  bool is_active(Time now) const {
    const double now_s = to_seconds(now);
    return now_s >= start_s && now_s < start_s + duration_s;
  }
};

}  // namespace patrol::sim
