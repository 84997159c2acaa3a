#pragma once

#include <Eigen/Core>

#include "core/sensors/sensor_traits.h"
#include "core/settings.h"
#include "core/time.h"

namespace patrol {

/// Specific force and angular rate, in `imu` (REP 145). At rest and level, the acceleration is +g on z.
struct Imu {
  Time stamp{};
  Eigen::Vector3d angular_velocity_radps = Eigen::Vector3d::Zero();
  Eigen::Vector3d linear_acceleration_mps2 = Eigen::Vector3d::Zero();
};

/// Inertial measurement unit (error model of IEEE Std 952). Defaults: Analog Devices ADIS16448 data sheet, rounded.
/// Messages below the rate of the ticks are samples without a low-pass filter: their noise density is larger by the
/// root of the ratio of the rates, 1.41 at 250 Hz and a tick of 2 ms.
///
/// The constant errors (biases, scale, misalignment) are one share of those of the data sheet. The other share is that
/// of the as-built robot, section as_built.imu, to which they are added. The root sum of squares of the default shares
/// is the value of the sheet. A nominal robot has the errors of this section only.
struct ImuSettings {
  bool enabled = true;                                   ///< presence of the sensor; false: no messages
  double rate_hz = 250.0;                                ///< message rate; the firmware reads the sensor at every tick
  double gyro_noise_density_radps_per_sqrt_hz = 2.3e-4;  ///< angle random walk of the samples at each tick, 0.66
                                                         ///< deg/sqrt(h) plus vibration
  double gyro_bias_std_radps = 0.002;                    ///< standard deviation of the constant bias of each axis
  double gyro_bias_random_walk_radps_per_sqrt_s = 1.0e-5;  ///< rate random walk
  double accel_noise_density_mps2_per_sqrt_hz = 0.002;     ///< noise density of the samples at each tick
  double accel_bias_std_mps2 = 0.03;                       ///< standard deviation of the constant bias of each axis
  double accel_bias_random_walk_mps2_per_sqrt_s = 1.0e-4;  ///< random walk of the accelerometer bias
  double scale_error_std = 0.001;                          ///< standard deviation of the scale factor of each axis
  double misalignment_std_deg = 0.0;      ///< standard deviation of the misalignment of each axis; all of that of the
                                          ///< sheet is in as_built.imu
  double gyro_range_radps = 17.4;         ///< largest angular rate that the gyro reports
  double accel_range_mps2 = 176.0;        ///< largest acceleration that the accelerometer reports
  double gyro_resolution_radps = 7.0e-4;  ///< step of the reported angular rate
  double accel_resolution_mps2 = 0.0082;  ///< step of the reported acceleration
  double latency_s = 0.0;                 ///< delay from the measurement to the delivery of the message

  template <typename Self, typename Visitor>
  static void fields(Self& self, Visitor& visit) {
    visit("enabled", self.enabled);
    visit("rate_hz", self.rate_hz, between(1.0, 500.0));
    visit("gyro_noise_density_radps_per_sqrt_hz", self.gyro_noise_density_radps_per_sqrt_hz, at_least(0.0));
    visit("gyro_bias_std_radps", self.gyro_bias_std_radps, at_least(0.0));
    visit("gyro_bias_random_walk_radps_per_sqrt_s", self.gyro_bias_random_walk_radps_per_sqrt_s, at_least(0.0));
    visit("accel_noise_density_mps2_per_sqrt_hz", self.accel_noise_density_mps2_per_sqrt_hz, at_least(0.0));
    visit("accel_bias_std_mps2", self.accel_bias_std_mps2, at_least(0.0));
    visit("accel_bias_random_walk_mps2_per_sqrt_s", self.accel_bias_random_walk_mps2_per_sqrt_s, at_least(0.0));
    visit("scale_error_std", self.scale_error_std, between(0.0, 0.5));
    visit("misalignment_std_deg", self.misalignment_std_deg, between(0.0, 10.0));
    visit("gyro_range_radps", self.gyro_range_radps, at_least(0.1));
    visit("accel_range_mps2", self.accel_range_mps2, at_least(1.0));
    visit("gyro_resolution_radps", self.gyro_resolution_radps, at_least(0.0));
    visit("accel_resolution_mps2", self.accel_resolution_mps2, at_least(0.0));
    visit("latency_s", self.latency_s, between(0.0, 10.0));
  }
};

template <>
struct SensorTraits<Imu> {
  struct Settings {
    ImuSettings imu;
  };
  static constexpr auto kSettings = &Settings::imu;
  static constexpr SensorInfo kInfo = {.name = "imu",
                                       .topic = "/imu/data",
                                       .ros_type = "sensor_msgs/msg/Imu",
                                       .summary = "inertial measurement unit",
                                       .frame = "imu",
                                       .timeout = SensorTimeout::kMotion,
                                       .freeze_check = FreezeCheck::kOdometry,
                                       .is_read_by_firmware = true,
                                       .fault = {.unit = "rad/s", .drift_per_s = 0.005, .outlier = 1.0}};

  /// Adds to the main reading, the yaw rate.
  static void add_to_reading(Imu& imu, double offset_radps) { imu.angular_velocity_radps.z() += offset_radps; }
  static bool repeats(const Imu& now, const Imu& before) {
    return now.angular_velocity_radps == before.angular_velocity_radps &&
           now.linear_acceleration_mps2 == before.linear_acceleration_mps2;
  }
  static std::vector<ErrorSource> error_sources() {
    return {{"gyro",
             {"sensors.imu.gyro_noise_density_radps_per_sqrt_hz=0", "sensors.imu.gyro_bias_std_radps=0",
              "sensors.imu.gyro_bias_random_walk_radps_per_sqrt_s=0", "sensors.imu.gyro_resolution_radps=0"}},
            {"accelerometer",
             {"sensors.imu.accel_noise_density_mps2_per_sqrt_hz=0", "sensors.imu.accel_bias_std_mps2=0",
              "sensors.imu.accel_bias_random_walk_mps2_per_sqrt_s=0", "sensors.imu.accel_resolution_mps2=0"}},
            {"IMU: scale and alignment", {"sensors.imu.scale_error_std=0", "sensors.imu.misalignment_std_deg=0"}}};
  }
};

}  // namespace patrol
