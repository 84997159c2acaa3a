#pragma once

#include <string>
#include <vector>

#include "core/sensors/sensor_traits.h"
#include "core/settings.h"
#include "core/time.h"

namespace patrol {

/// Reading of one transducer of the ultrasonic ring: distance to the nearest echo within its cone, along x of its
/// frame.
struct UltrasonicRange {
  Time stamp{};
  int transducer = 0;              ///< number of the transducer; its frame is `ultrasonic_<transducer>`
  double field_of_view_rad = 0.0;  ///< full opening angle of the cone
  double range_min_m = 0.0;
  double range_max_m = 0.0;
  float range_m = 0.0F;  ///< range, REP 117: -Inf too close, +Inf no echo
};

/// Ring of ultrasonic transducers of the class of MaxBotix's XL-MaxSonar-EZ (data sheet PD11840). The frequency is 42
/// kHz, the minimum range 0.2 m, the step 1 cm. Closer objects are reported as too near, and the accuracy is limited by
/// the air temperature. Reflection follows [Leonard92]: at a wavelength of 8 mm walls are mirrors. The two values of
/// the echo strength are assumptions.
struct UltrasonicSettings {
  bool enabled = false;                ///< presence of the sensor; false: no messages
  double ping_rate_hz = 40.0;          ///< rate of ring slots; one transducer or one group fires in each slot
  int group_size = 1;                  ///< transducers per group, spread over the ring; a group shortens the cycle and
                                       ///< causes crosstalk
  double fov_deg = 35.0;               ///< full opening angle of the cone
  double range_min_m = 0.2;            ///< minimum range of an echo
  double range_max_m = 4.0;            ///< maximum range of an echo
  double range_noise_std_m = 0.005;    ///< standard deviation of the range
  double range_quantization_m = 0.01;  ///< step of the reported range
  double specular_cutoff_deg = 25.0;   ///< maximum angle of incidence for a specular echo of a smooth surface
  double rough_echo_ratio = 0.37;      ///< echo strength of a rough surface relative to a smooth one, both at normal
                                       ///< incidence
  double detection_threshold =
      0.02;  ///< detection threshold, relative to the echo of a smooth wall that fills the cone
  double dropout_probability = 0.02;    ///< dropout probability of a ping
  double crosstalk_probability = 0.5;   ///< probability that a receivable echo of another transducer is taken for the
                                        ///< own echo
  double air_temperature_c = 15.0;      ///< temperature of the air, which determines the speed of sound
  double assumed_temperature_c = 20.0;  ///< temperature for which the sensor's speed of sound is set
  /// Parts of the names of rough geoms or of their materials; height fields are always rough.
  std::vector<std::string> rough_names = {"rock", "rubble", "gravel", "soil", "shotcrete", "muck"};
  double latency_s = 0.03;  ///< delay that covers the echo from maximum range

  template <typename Self, typename Visitor>
  static void fields(Self& self, Visitor& visit) {
    visit("enabled", self.enabled);
    visit("ping_rate_hz", self.ping_rate_hz, between(0.1, 200.0));
    visit("group_size", self.group_size, between(1, 64));
    visit("fov_deg", self.fov_deg, between(1.0, 150.0));
    visit("range_min_m", self.range_min_m, at_least(0.0));
    visit("range_max_m", self.range_max_m, between(0.1, 20.0));
    visit("range_noise_std_m", self.range_noise_std_m, at_least(0.0));
    visit("range_quantization_m", self.range_quantization_m, at_least(0.0));
    visit("specular_cutoff_deg", self.specular_cutoff_deg, between(0.0, 90.0));
    visit("rough_echo_ratio", self.rough_echo_ratio, between(0.0, 1.0));
    visit("detection_threshold", self.detection_threshold, between(0.0, 1.0));
    visit("dropout_probability", self.dropout_probability, between(0.0, 1.0));
    visit("crosstalk_probability", self.crosstalk_probability, between(0.0, 1.0));
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
                                       .frame = "ultrasonic_0",
                                       .timeout = SensorTimeout::kInstrument,
                                       .fault = {.unit = "m", .drift_per_s = 0.02, .outlier = 0.5}};

  static void add_to_reading(UltrasonicRange& range, double offset_m) { range.range_m += static_cast<float>(offset_m); }
};

}  // namespace patrol
