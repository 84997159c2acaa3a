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
  std::string sensor = "lidar";  ///< name of the sensor
  std::string kind = "dropout";  ///< kind of the fault (`patrol list sensor_faults`)
  double start_s = 0.0;          ///< time of the start of the fault
  double duration_s = 1.0;       ///< duration of the fault
  /// Magnitude of the fault. For a delay in s; for jitter the standard deviation of a normal draw per message whose
  /// absolute value is the delay, in s; for a clock offset in s. For a drift in units of the sensor per s; for outliers
  /// in units of the sensor.
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
