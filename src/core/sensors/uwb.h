#pragma once

#include "core/sensors/sensor_traits.h"
#include "core/settings.h"
#include "core/time.h"

namespace patrol {

/// Two-way ultra-wideband range from the robot's antenna (frame `uwb`) to one anchor. Lost ranges are not sent.
struct UwbRange {
  Time stamp{};
  int anchor = 0;  ///< number of the anchor in the site survey
  double range_m = 0.0;
};

/// Ultra-wideband two-way ranging after Decawave's DW1000: data sheet (ranges to about 10 cm) and application note
/// APS011 "Sources of error in DW1000 based two-way ranging schemes" (bias). Errors are Gaussian in line of sight
/// (LOS); an exponential NLOS bias is added off it [Alsindi09], [Bellusci09]. Loss probabilities are assumptions.
struct UwbSettings {
  bool enabled = false;                ///< presence of the sensor; false: no messages
  double rate_hz = 30.0;               ///< total rate of polls; the anchors in range take turns
  double range_max_m = 60.0;           ///< maximum range; anchors farther away are neither polled nor answer
  double range_noise_std_m = 0.07;     ///< standard deviation of the range in line of sight
  double bias_scale = 1.0;             ///< factor on the distance-dependent bias; 0: corrected by the firmware
  double loss_probability = 0.02;      ///< loss probability of a poll at short distance
  double nlos_loss_probability = 0.3;  ///< additional loss probability off the line of sight
  double nlos_bias_m = 0.4;            ///< mean of the exponential NLOS bias
  double latency_s = 0.01;             ///< delay from the measurement to the delivery of the message

  template <typename Self, typename Visitor>
  static void fields(Self& self, Visitor& visit) {
    visit("enabled", self.enabled);
    visit("rate_hz", self.rate_hz, between(0.1, 500.0));
    visit("range_max_m", self.range_max_m, between(1.0, 1000.0));
    visit("range_noise_std_m", self.range_noise_std_m, at_least(0.0));
    visit("bias_scale", self.bias_scale, between(-5.0, 5.0));
    visit("loss_probability", self.loss_probability, between(0.0, 1.0));
    visit("nlos_loss_probability", self.nlos_loss_probability, between(0.0, 1.0));
    visit("nlos_bias_m", self.nlos_bias_m, at_least(0.0));
    visit("latency_s", self.latency_s, between(0.0, 10.0));
  }
};

template <>
struct SensorTraits<UwbRange> {
  struct Settings {
    UwbSettings uwb;
  };
  static constexpr auto kSettings = &Settings::uwb;
  static constexpr SensorInfo kInfo = {.name = "uwb",
                                       .topic = "/uwb/range",
                                       .ros_type = "patrol_msgs/msg/UwbRange",
                                       .summary = "ultra-wideband ranges to surveyed anchors",
                                       .frame = "uwb",
                                       .timeout = SensorTimeout::kInstrument,
                                       .fault = {.unit = "m", .drift_per_s = 0.05, .outlier = 3.0}};

  static void add_to_reading(UwbRange& range, double offset_m) { range.range_m += offset_m; }
  static std::vector<ErrorSource> error_sources() {
    return {{"UWB: range noise", {"sensors.uwb.range_noise_std_m=0"}},
            {"UWB: distance-dependent bias", {"sensors.uwb.bias_scale=0"}},
            {"UWB: non-line-of-sight paths", {"sensors.uwb.nlos_loss_probability=0", "sensors.uwb.nlos_bias_m=0"}},
            {"UWB: loss", {"sensors.uwb.loss_probability=0"}}};
  }
};

}  // namespace patrol
