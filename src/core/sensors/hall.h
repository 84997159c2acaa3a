#pragma once

#include <cmath>
#include <cstdint>
#include <numbers>

#include "core/sensors/sensor_traits.h"
#include "core/settings.h"
#include "core/time.h"

namespace patrol {

/// Counts of the Hall sensors on the drive motors since power-up; positive is forward.
struct TrackTicks {
  Time stamp{};
  std::int64_t left = 0;
  std::int64_t right = 0;
};

/// Hall sensors in the drive motors, counting the edges of the rotor's magnets. Three sensors on a rotor of four pole
/// pairs, with every edge counted, give 24 counts per revolution; the gear multiplies them. Data sheets of flat
/// brushless motors of this class (e.g. maxon EC flat) list 7 to 11 pole pairs and 3 sensors; the default is coarser.
struct HallSettings {
  bool enabled = true;                   ///< presence of the sensor; false: no messages
  double rate_hz = 50.0;                 ///< message rate; the firmware reads the sensor at every tick
  int counts_per_motor_revolution = 24;  ///< number of encoder counts per revolution of a motor
  double gear_ratio = 30.0;              ///< motor revolutions per sprocket revolution
  double missed_edge_probability = 0.0;  ///< probability that an edge is not counted
  double latency_s = 0.0;                ///< delay from the measurement to the delivery of the message

  /// Returns the counts per radian of the sprocket.
  double ticks_per_rad() const { return counts_per_motor_revolution * gear_ratio / (2.0 * std::numbers::pi); }

  template <typename Self, typename Visitor>
  static void fields(Self& self, Visitor& visit) {
    visit("enabled", self.enabled);
    visit("rate_hz", self.rate_hz, between(1.0, 500.0));
    visit("counts_per_motor_revolution", self.counts_per_motor_revolution, between(1, 10000));
    visit("gear_ratio", self.gear_ratio, between(1.0, 1000.0));
    visit("missed_edge_probability", self.missed_edge_probability, between(0.0, 1.0));
    visit("latency_s", self.latency_s, between(0.0, 10.0));
  }
};

template <>
struct SensorTraits<TrackTicks> {
  struct Settings {
    HallSettings hall;
  };
  static constexpr auto kSettings = &Settings::hall;
  static constexpr SensorInfo kInfo = {.name = "hall",
                                       .topic = "/track_ticks",
                                       .ros_type = "patrol_msgs/msg/TrackTicks",
                                       .summary = "Hall counters of the drive motors",
                                       .timeout = SensorTimeout::kMotion,
                                       .freeze_check = FreezeCheck::kCommand,
                                       .is_required_to_drive = true,
                                       .is_read_by_firmware = true,
                                       .fault = {.unit = "counts", .drift_per_s = 50.0, .outlier = 500.0}};

  /// Adds to the main reading, the count of the left track.
  static void add_to_reading(TrackTicks& ticks, double offset_counts) { ticks.left += std::llround(offset_counts); }
  static bool repeats(const TrackTicks& now, const TrackTicks& before) {
    return now.left == before.left && now.right == before.right;
  }
  static bool is_fitted(const RobotDescription& robot) { return robot.tracks.has_value(); }
  static std::vector<ErrorSource> error_sources() {
    return {{"Hall counters: missed edges", {"sensors.hall.missed_edge_probability=0"}}};
  }
};

}  // namespace patrol
