#pragma once

#include <cstdint>

#include <mujoco/mujoco.h>

#include "core/messages.h"
#include "core/random.h"
#include "core/settings.h"

namespace patrol::sim {

/// An inertial measuring unit (IEEE Std 952 error model). Defaults: Analog Devices ADIS16448 data sheet, rounded.
struct ImuSettings {
  bool enabled = true;
  double rate_hz = 250.0;                         ///< of the messages; the firmware reads at every tick
  double gyro_noise_radps_rthz = 2.3e-4;          ///< angle random walk, 0.66 deg/sqrt(h) and vibration
  double gyro_bias_radps = 0.002;                 ///< standard deviation of the constant part
  double gyro_bias_walk_radps2_rthz = 1.0e-5;     ///< rate random walk
  double accel_noise_mps2_rthz = 0.002;
  double accel_bias_mps2 = 0.03;
  double accel_bias_walk_mps3_rthz = 1.0e-4;
  double scale_error = 0.001;                     ///< standard deviation, of each axis
  double misalignment_deg = 0.05;                 ///< standard deviation, of each axis
  double gyro_range_radps = 17.4;
  double accel_range_mps2 = 176.0;
  double gyro_resolution_radps = 7.0e-4;
  double accel_resolution_mps2 = 0.0082;
  double latency_s = 0.0;

  template <typename Self, typename Visitor>
  static void fields(Self& self, Visitor& visit) {
    visit("enabled", self.enabled);
    visit("rate_hz", self.rate_hz, between(1.0, 500.0));
    visit("gyro_noise_radps_rthz", self.gyro_noise_radps_rthz, at_least(0.0));
    visit("gyro_bias_radps", self.gyro_bias_radps, at_least(0.0));
    visit("gyro_bias_walk_radps2_rthz", self.gyro_bias_walk_radps2_rthz, at_least(0.0));
    visit("accel_noise_mps2_rthz", self.accel_noise_mps2_rthz, at_least(0.0));
    visit("accel_bias_mps2", self.accel_bias_mps2, at_least(0.0));
    visit("accel_bias_walk_mps3_rthz", self.accel_bias_walk_mps3_rthz, at_least(0.0));
    visit("scale_error", self.scale_error, between(0.0, 0.5));
    visit("misalignment_deg", self.misalignment_deg, between(0.0, 10.0));
    visit("gyro_range_radps", self.gyro_range_radps, at_least(0.1));
    visit("accel_range_mps2", self.accel_range_mps2, at_least(1.0));
    visit("gyro_resolution_radps", self.gyro_resolution_radps, at_least(0.0));
    visit("accel_resolution_mps2", self.accel_resolution_mps2, at_least(0.0));
    visit("latency_s", self.latency_s, between(0.0, 10.0));
  }
};

/// Reads specific force and rate at the site `imu` at every tick. The scale and the biases are drawn once per run.
class ImuSensor {
 public:
  ImuSensor(const ImuSettings& settings, const mjModel& model, std::uint64_t seed);

  /// `tick` counts readings; the bias walks with it.
  Imu read(const mjModel& model, mjData& data, Time now, std::uint64_t tick);

  /// The same from given truth, in `imu`.
  Imu corrupt(const Eigen::Vector3d& rate_radps, const Eigen::Vector3d& force_mps2, Time now, std::uint64_t tick);

 private:
  /// One triad, gyroscope or accelerometer.
  struct Triad {
    RandomStream noise, walk;
    Eigen::Matrix3d distortion;  ///< scale and misalignment
    Eigen::Vector3d bias;
    double noise_std, walk_std, range, resolution;
  };
  static Triad make_triad(std::uint64_t seed, const char* name, const ImuSettings& settings, double tick_s, double noise,
                          double bias, double walk, double range, double resolution);
  static Eigen::Vector3d measure(Triad& triad, const Eigen::Vector3d& truth, std::uint64_t tick);

  int site_;
  Triad gyro_, accel_;
};

}  // namespace patrol::sim
