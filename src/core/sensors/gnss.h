#pragma once

#include <cstdint>

#include <Eigen/Core>

#include "core/sensors/sensor_traits.h"
#include "core/settings.h"
#include "core/time.h"

namespace patrol {

enum class GnssStatus : std::uint8_t { kNone, kFloat, kFix };

/// Antenna position in WGS 84.
struct GnssFix {
  Time stamp{};
  GnssStatus status = GnssStatus::kNone;
  double latitude_deg = 0.0;
  double longitude_deg = 0.0;
  double altitude_m = 0.0;
  Eigen::Vector3d position_std_m = Eigen::Vector3d::Zero();  ///< standard deviation of the position: east, north, up
};

/// RTK receiver. Defaults after u-blox's ZED-F9P data sheet (1 cm + 1 ppm with fixed ambiguities).
struct GnssSettings {
  bool enabled = true;                     ///< presence of the sensor; false: no messages
  double rate_hz = 5.0;                    ///< rate of the messages
  double fix_noise_std_m = 0.01;           ///< horizontal standard deviation; the vertical one is twice as large
  double float_noise_std_m = 0.4;          ///< standard deviation of the position with a float solution
  double error_correlation_time_s = 20.0;  ///< correlation time of the position error
  double min_open_sky_fix = 0.75;          ///< minimum fraction of visible sky for a fixed solution
  double min_open_sky_float = 0.45;        ///< minimum fraction of visible sky for a float solution
  double fix_reacquisition_time_s = 5.0;   ///< time under open sky before a fixed solution returns
  double datum_latitude_deg = 29.21;       ///< WGS 84 latitude of the world's origin
  double datum_longitude_deg = 119.46;     ///< longitude of the origin of the world (WGS 84)
  double latency_s = 0.1;                  ///< delay from the measurement to the delivery of the message

  template <typename Self, typename Visitor>
  static void fields(Self& self, Visitor& visit) {
    visit("enabled", self.enabled);
    visit("rate_hz", self.rate_hz, between(0.1, 50.0));
    visit("fix_noise_std_m", self.fix_noise_std_m, at_least(0.0));
    visit("float_noise_std_m", self.float_noise_std_m, at_least(0.0));
    visit("error_correlation_time_s", self.error_correlation_time_s, at_least(0.1));
    visit("min_open_sky_fix", self.min_open_sky_fix, between(0.0, 1.0));
    visit("min_open_sky_float", self.min_open_sky_float, between(0.0, 1.0));
    visit("fix_reacquisition_time_s", self.fix_reacquisition_time_s, at_least(0.0));
    visit("datum_latitude_deg", self.datum_latitude_deg, between(-85.0, 85.0));
    visit("datum_longitude_deg", self.datum_longitude_deg, between(-180.0, 180.0));
    visit("latency_s", self.latency_s, between(0.0, 10.0));
  }
};

template <>
struct SensorTraits<GnssFix> {
  struct Settings {
    GnssSettings gnss;
  };
  static constexpr auto kSettings = &Settings::gnss;
  static constexpr SensorInfo kInfo = {.name = "gnss",
                                       .topic = "/gnss/fix",
                                       .ros_type = "sensor_msgs/msg/NavSatFix",
                                       .summary = "RTK GNSS receiver",
                                       .frame = "gnss",
                                       .timeout = SensorTimeout::kInstrument,
                                       .fault = {.unit = "m", .drift_per_s = 0.2, .outlier = 5.0}};

  /// Adds to the main reading, the altitude.
  static void add_to_reading(GnssFix& fix, double offset_m) { fix.altitude_m += offset_m; }
};

}  // namespace patrol
