#pragma once

#include <cstdint>

#include <mujoco/mujoco.h>

#include "core/random.h"
#include "core/sensors/registry.h"
#include "core/settings.h"
#include "sim/as_built/sensor_errors.h"

namespace patrol::sim {

/// IMU model: specific force and angular rate at the site `imu`, read at every tick. Scale factors and initial biases
/// are sampled once per run; those of the as-built robot are added.
class ImuSensor {
 public:
  /// Returns the constant biases of the settings, without those of the as-built robot.
  static ImuErrors constant_biases(const ImuSettings& settings, std::uint64_t seed);

  ImuSensor(const ImuSettings& settings, const mjModel& model, std::uint64_t seed, const ImuErrors& errors = {});

  /// Takes reading number `tick`; the bias random walk advances with it.
  Imu read(const mjModel& model, mjData& data, Time now, std::uint64_t tick);

  /// Returns the reading of a given ground truth, in `imu`.
  Imu corrupt(const Eigen::Vector3d& rate_radps, const Eigen::Vector3d& force_mps2, Time now, std::uint64_t tick);

  template <typename Archive>
  void serialize_state(Archive& archive) {
    archive(gyro_.bias, accel_.bias);
  }

 private:
  /// Triad of axes: gyroscope or accelerometer.
  struct Triad {
    RandomStream noise, walk;
    Eigen::Matrix3d distortion;  ///< scale and misalignment
    Eigen::Vector3d bias;
    Eigen::Vector3d bias_per_k;
    double noise_std, walk_std, range, resolution;
  };
  /// Values of the settings for a triad, in its units.
  struct TriadSheet {
    double noise_density, bias_std, bias_random_walk, range, resolution, scale_error_std, misalignment_std_deg;
  };
  static TriadSheet gyro_sheet(const ImuSettings& settings);
  static TriadSheet accel_sheet(const ImuSettings& settings);
  static Triad make_triad(std::uint64_t seed, const char* name, const TriadSheet& sheet, double tick_s);
  static void add_errors(const TriadErrors& errors, Triad& triad);
  static Eigen::Vector3d measure(Triad& triad, const Eigen::Vector3d& truth, double temperature_rise_k,
                                 std::uint64_t tick);

  int site_;
  ImuErrors errors_;
  Triad gyro_, accel_;
};

}  // namespace patrol::sim
