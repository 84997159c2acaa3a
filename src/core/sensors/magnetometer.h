#pragma once

#include <string>
#include <vector>

#include <Eigen/Core>

#include "core/sensors/sensor_traits.h"
#include "core/settings.h"
#include "core/time.h"

namespace patrol {

/// Magnetic flux density in `imu`; the magnetometer is in the IMU housing.
struct MagneticField {
  Time stamp{};
  Eigen::Vector3d field_t = Eigen::Vector3d::Zero();
  double std_t = 0.0;  ///< standard deviation of the noise of each axis, T
};

/// Three-axis magnetometer with the data of ST's LIS3MDL (data sheet DocID024204): full scale of 4 gauss at 6842
/// LSB/gauss, noise of at most 4.1 mgauss rms. The geomagnetic field approximates the World Magnetic Model at the datum
/// of the GNSS settings. Hard iron, soft iron and the polarizability of steel are assumptions.
struct MagnetometerSettings {
  bool enabled = false;             ///< presence of the sensor; false: no messages
  double rate_hz = 50.0;            ///< rate of the messages
  double intensity_t = 4.87e-5;     ///< magnitude of the geomagnetic field, T
  double inclination_deg = 45.0;    ///< angle of the geomagnetic field below the horizon
  double declination_deg = -5.6;    ///< angle of the geomagnetic field from north (+y of world) toward east (+x)
  double hard_iron_std_t = 1.0e-5;  ///< standard deviation, over robots, of the constant offset of each axis, T
  double soft_iron_std = 0.03;      ///< standard deviation, over robots, of each entry of distortion matrix - identity
  double noise_std_t = 4.1e-7;      ///< standard deviation of the noise of each axis, T
  double resolution_t = 1.4616e-8;  ///< quantization step, T
  double range_t = 4.0e-4;          ///< full scale of each axis, T
  double steel_fill = 0.1;          ///< polarizable fraction of a steel geom's bounding box; 0: no disturbance
  /// Parts of the names of steel geoms or of their materials.
  std::vector<std::string> steel_names = {"steel", "iron", "metal", "car_", "rail", "reinforcement"};
  double latency_s = 0.01;  ///< delay from the measurement to the delivery of the message

  template <typename Self, typename Visitor>
  static void fields(Self& self, Visitor& visit) {
    visit("enabled", self.enabled);
    visit("rate_hz", self.rate_hz, between(0.1, 500.0));
    visit("intensity_t", self.intensity_t, between(0.0, 1.0e-3));
    visit("inclination_deg", self.inclination_deg, between(-90.0, 90.0));
    visit("declination_deg", self.declination_deg, between(-180.0, 180.0));
    visit("hard_iron_std_t", self.hard_iron_std_t, between(0.0, 1.0e-3));
    visit("soft_iron_std", self.soft_iron_std, between(0.0, 0.3));
    visit("noise_std_t", self.noise_std_t, between(0.0, 1.0e-3));
    visit("resolution_t", self.resolution_t, between(0.0, 1.0e-4));
    visit("range_t", self.range_t, between(1.0e-6, 1.0));
    visit("steel_fill", self.steel_fill, between(0.0, 1.0));
    visit("steel_names", self.steel_names);
    visit("latency_s", self.latency_s, between(0.0, 10.0));
  }
};

template <>
struct SensorTraits<MagneticField> {
  struct Settings {
    MagnetometerSettings magnetometer;
  };
  static constexpr auto kSettings = &Settings::magnetometer;
  static constexpr SensorInfo kInfo = {.name = "magnetometer",
                                       .topic = "/imu/mag",
                                       .ros_type = "sensor_msgs/msg/MagneticField",
                                       .summary = "three-axis magnetometer",
                                       .frame = "imu",
                                       .timeout = SensorTimeout::kInstrument,
                                       .fault = {.unit = "T", .drift_per_s = 1.0e-6, .outlier = 3.0e-5}};

  /// Adds to the main reading, the field along x.
  static void add_to_reading(MagneticField& reading, double offset_t) { reading.field_t.x() += offset_t; }
  static std::vector<ErrorSource> error_sources() {
    return {{"magnetometer: noise", {"sensors.magnetometer.noise_std_t=0", "sensors.magnetometer.resolution_t=0"}},
            {"magnetometer: hard and soft iron",
             {"sensors.magnetometer.hard_iron_std_t=0", "sensors.magnetometer.soft_iron_std=0"}},
            {"magnetometer: steel nearby", {"sensors.magnetometer.steel_fill=0"}}};
  }
};

}  // namespace patrol
