#pragma once

#include <vector>

#include "core/sensors/sensor_traits.h"
#include "core/settings.h"
#include "core/time.h"

namespace patrol {

/// Forces on the foot sensors, in the order of RobotDescription::legs.
struct FootContacts {
  Time stamp{};
  std::vector<double> force_n;
};

/// Force sensors in the feet: strain gauges with an offset per foot that is constant over a run.
struct FootContactSettings {
  bool enabled = true;        ///< presence of the sensor; false: no messages
  double rate_hz = 250.0;     ///< message rate; the firmware reads the sensor at every tick
  double noise_std_n = 1.0;   ///< standard deviation of the noise
  double offset_std_n = 1.0;  ///< standard deviation of the offset
  double resolution_n = 0.5;  ///< step of the reported force
  double range_n = 500.0;     ///< largest force that the sensor reports
  double latency_s = 0.0;     ///< delay from the measurement to the delivery of the message

  template <typename Self, typename Visitor>
  static void fields(Self& self, Visitor& visit) {
    visit("enabled", self.enabled);
    visit("rate_hz", self.rate_hz, between(1.0, 500.0));
    visit("noise_std_n", self.noise_std_n, at_least(0.0));
    visit("offset_std_n", self.offset_std_n, at_least(0.0));
    visit("resolution_n", self.resolution_n, at_least(0.0));
    visit("range_n", self.range_n, at_least(1.0));
    visit("latency_s", self.latency_s, between(0.0, 10.0));
  }
};

template <>
struct SensorTraits<FootContacts> {
  struct Settings {
    FootContactSettings foot_contact;
  };
  static constexpr auto kSettings = &Settings::foot_contact;
  static constexpr SensorInfo kInfo = {.name = "foot_contact",
                                       .topic = "/foot_contacts",
                                       .ros_type = "patrol_msgs/msg/FootContacts",
                                       .summary = "force sensors of the feet",
                                       .timeout = SensorTimeout::kMotion,
                                       .freeze_check = FreezeCheck::kCommand,
                                       .is_read_by_firmware = true,
                                       .fault = {.unit = "N", .drift_per_s = 10.0, .outlier = 100.0}};

  /// Adds to the main reading, the force on the first foot.
  static void add_to_reading(FootContacts& contacts, double offset_n) {
    if (!contacts.force_n.empty()) contacts.force_n.front() += offset_n;
  }
  static bool repeats(const FootContacts& now, const FootContacts& before) { return now.force_n == before.force_n; }
  static bool is_fitted(const RobotDescription& robot) { return !robot.legs.empty(); }
  static std::vector<ErrorSource> error_sources() {
    return {{"foot contact: noise",
             {"sensors.foot_contact.noise_std_n=0", "sensors.foot_contact.offset_std_n=0",
              "sensors.foot_contact.resolution_n=0"}}};
  }
};

}  // namespace patrol
