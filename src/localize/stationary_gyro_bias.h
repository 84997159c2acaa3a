#pragma once

#include <array>
#include <optional>

#include <Eigen/Core>

#include "core/geometry/zeros.h"
#include "core/time.h"
#include "localize/leg_odometry.h"

namespace patrol::localize {

/// Measurement of the gyro bias during a standstill.
struct GyroBiasMeasurement {
  Eigen::Vector3d bias_radps = Eigen::Vector3d::Zero();  ///< in body
  Eigen::Vector3d variance = Eigen::Vector3d::Zero();    ///< (rad/s)2
};

/// Estimator of the gyro bias while all feet are on the ground. A standing trunk still sways, so its rate is not
/// assumed zero. Its rotation is measured with the feet (rigid fit of their positions in body); the rest of the
/// integrated gyro rate is bias. Windows with a slipping foot (residual of the fit) are rejected.
class StationaryGyroBiasEstimator {
 public:
  struct Settings {
    double window_s;
    double gyro_noise_density_radps_per_sqrt_hz;
    /// Standard deviation of the mean foot position at one end of the window: averaged encoder noise, and creep.
    double foot_std_m;
  };
  explicit StationaryGyroBiasEstimator(const Settings& settings) : settings_(settings) {}

  /// Adds a sample: contact points of all feet in body, and the raw gyro rate. Returns a bias measurement at the end of
  /// each complete window.
  std::optional<GyroBiasMeasurement> add(Time stamp, const StanceFeet& all_feet, const Eigen::Vector3d& gyro_radps);
  /// Starts a new window, after a foot was lifted or data were missing.
  void reset() { is_open_ = false; }

  template <typename Archive>
  void serialize_state(Archive& archive) {
    archive(is_open_, start_, last_, last_gyro_, gyro_angle_rad_, first_, final_);
  }

 private:
  using FootPositions = std::array<Eigen::Vector3d, kNumLegs>;
  /// Mean over the samples at one end of the window.
  struct End {
    FootPositions foot_m = zeros<FootPositions>();
    Eigen::Vector3d gyro_angle_rad = Eigen::Vector3d::Zero();
    double time_s = 0.0;
    int count = 0;

    void add(const StanceFeet& feet, const Eigen::Vector3d& gyro_angle, double time);
    void divide();
  };

  std::optional<GyroBiasMeasurement> close();

  Settings settings_;
  bool is_open_ = false;
  Time start_{};
  Time last_{};
  Eigen::Vector3d last_gyro_ = Eigen::Vector3d::Zero();
  Eigen::Vector3d gyro_angle_rad_ = Eigen::Vector3d::Zero();  ///< integrated since the start of the window
  End first_, final_;
};

}  // namespace patrol::localize
