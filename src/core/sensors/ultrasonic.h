#pragma once

#include <string>
#include <vector>

#include "core/sensors/sensor_traits.h"
#include "core/settings.h"
#include "core/time.h"

namespace patrol {

/// One ping of one transducer of the ultrasonic ring: distance to the nearest echo within its cone, along x of its frame.
struct UltrasonicRange {
  Time stamp{};
  int transducer = 0;  ///< its frame is `ultrasonic_<transducer>`
  double field_of_view_rad = 0.0;  ///< full angle of the cone
  double range_min_m = 0.0;
  double range_max_m = 0.0;
  float range_m = 0.0F;  ///< REP 117: -Inf too close, +Inf no echo
};

/// A ring of ultrasonic transducers, each of the class of MaxBotix's XL-MaxSonar-EZ (data sheet PD11840: 42 kHz, from 0.2 m,
/// steps of 1 cm, nearer things reported as too near, accuracy by the temperature of the air). Where sound comes back from
/// follows Leonard, Durrant-Whyte, "Directed sonar sensing for mobile robot navigation", 1992: at a wavelength of 8 mm walls
/// are mirrors. The two figures of the echo's strength are assumptions.
struct UltrasonicSettings {
  bool enabled = false;
  double ping_rate_hz = 40.0;      ///< slots of the ring; in each, one transducer or one group of them fires
  int fire_together = 1;           ///< transducers of a group, spread round the ring: a faster round, and cross-talk
  double fov_deg = 35.0;           ///< full angle of the cone
  double range_min_m = 0.2;
  double range_max_m = 4.0;
  double range_noise_m = 0.005;    ///< standard deviation
  double range_resolution_m = 0.01;
  double smooth_deg = 25.0;        ///< a smooth surface met flatter than this from its normal throws the sound elsewhere
  double rough_echo = 0.37;        ///< echo of a rough surface, of that of a smooth one, both met squarely
  double least_echo = 0.02;        ///< least echo that is heard, of that of a smooth wall before the whole cone
  double dropout = 0.02;           ///< share of pings that hear nothing for no reason
  double crosstalk = 0.5;          ///< chance that another's echo is taken for one's own, where it can be heard
  double air_temperature_c = 15.0;
  double assumed_temperature_c = 20.0;  ///< for which the speed of sound is set
  /// Words in the names of rough geoms or of their materials; height fields are rough.
  std::vector<std::string> rough_names = {"rock", "rubble", "gravel", "soil", "shotcrete", "muck"};
  double latency_s = 0.03;         ///< until the farthest echo could have come

  template <typename Self, typename Visitor>
  static void fields(Self& self, Visitor& visit) {
    visit("enabled", self.enabled);
    visit("ping_rate_hz", self.ping_rate_hz, between(0.1, 200.0));
    visit("fire_together", self.fire_together, between(1, 64));
    visit("fov_deg", self.fov_deg, between(1.0, 150.0));
    visit("range_min_m", self.range_min_m, at_least(0.0));
    visit("range_max_m", self.range_max_m, between(0.1, 20.0));
    visit("range_noise_m", self.range_noise_m, at_least(0.0));
    visit("range_resolution_m", self.range_resolution_m, at_least(0.0));
    visit("smooth_deg", self.smooth_deg, between(0.0, 90.0));
    visit("rough_echo", self.rough_echo, between(0.0, 1.0));
    visit("least_echo", self.least_echo, between(0.0, 1.0));
    visit("dropout", self.dropout, between(0.0, 1.0));
    visit("crosstalk", self.crosstalk, between(0.0, 1.0));
    visit("air_temperature_c", self.air_temperature_c, between(-40.0, 85.0));
    visit("assumed_temperature_c", self.assumed_temperature_c, between(-40.0, 85.0));
    visit("rough_names", self.rough_names);
    visit("latency_s", self.latency_s, between(0.0, 10.0));
  }
};

template <>
struct SensorTraits<UltrasonicRange> {
  struct Settings {
    UltrasonicSettings ultrasonic;
  };
  static constexpr auto kSettings = &Settings::ultrasonic;
  static constexpr SensorInfo kInfo = {.name = "ultrasonic",
                                      .topic = "/ultrasonic",
                                      .ros_type = "sensor_msgs/msg/Range",
                                      .summary = "ultrasonic ring",
                                      .timeout = SensorTimeout::kInstrument,
                                      .fault = {.unit = "m", .drift_per_s = 0.02, .spike = 0.5}};

  static void add_to_reading(UltrasonicRange& range, double offset_m) { range.range_m += static_cast<float>(offset_m); }
};

}  // namespace patrol
