#pragma once

#include <Eigen/Core>

#include <array>
#include <optional>

#include "core/time.h"
#include "localize/leg_odometry.h"

namespace patrol::localize {

/// The gyro's bias, seen while the robot stands.
struct GyroBiasReading {
  Eigen::Vector3d bias_radps = Eigen::Vector3d::Zero();  ///< in body
  Eigen::Vector3d variance = Eigen::Vector3d::Zero();    ///< (rad/s)2
};

/// Measures the gyro's bias while all feet stand. A standing trunk still sways, so its rate is not taken to
/// be zero: how far it has turned is read from the feet (a rigid fit of their positions in body), and what
/// the gyro has summed up beyond that is bias. Windows in which a foot slipped (the fit leaves a residual)
/// are thrown away.
class StandstillBiasMeter {
 public:
  struct Settings {
    double window_s;
    double gyro_noise_radps_per_sqrt_hz;
    double foot_std_m;  ///< of a foot's mean position at one end of the window: encoder noise, averaged, and
                        ///< creep
  };
  explicit StandstillBiasMeter(const Settings& settings) : settings_(settings) {}

  /// One instant: the contacts of all feet in body and the gyro as read. A reading at the end of each whole
  /// window.
  std::optional<GyroBiasReading> add(Time stamp, const StanceFeet& all_feet,
                                     const Eigen::Vector3d& gyro_radps);
  /// A foot was lifted, or data is missing.
  void reset() { is_open_ = false; }

 private:
  using FootPositions = std::array<Eigen::Vector3d, kNumLegs>;
  /// Mean over the samples at one end of the window.
  struct End {
    FootPositions foot_m{};
    Eigen::Vector3d gyro_angle_rad = Eigen::Vector3d::Zero();
    double time_s = 0.0;
    int count = 0;

    void add(const StanceFeet& feet, const Eigen::Vector3d& gyro_angle, double time);
    void divide();
  };

  std::optional<GyroBiasReading> close();

  Settings settings_;
  bool is_open_ = false;
  Time start_{};
  Time last_{};
  Eigen::Vector3d last_gyro_ = Eigen::Vector3d::Zero();
  Eigen::Vector3d gyro_angle_rad_ = Eigen::Vector3d::Zero();  ///< summed up since the window's start
  End first_, final_;
};

}  // namespace patrol::localize
