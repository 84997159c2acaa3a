#pragma once

#include <Eigen/Core>

#include "core/frames.h"

namespace patrol::slam {

/// Online calibration of wheel odometry against matched scans: scales of distance and turn, and a steering bias, the
/// turn per meter of a robot that drives straight by its encoders. A Kalman filter whose values drift slowly.
/// Measurements that contradict the estimate are down-weighted (Student's t).
class OdometryCorrection {
 public:
  struct Values {
    double distance_scale = 1.0;
    double turn_scale = 1.0;
    double steering_rad_per_m = 0.0;
  };

  /// Returns the motion that belongs to an odometry increment.
  Pose2 corrected(const Pose2& T_before_now) const;

  /// Standard deviations of the difference between a matched motion and its odometry increment.
  struct Noise {
    double std_m, std_rad;
  };

  /// Uses a matched motion. `odometry` is the increment between the same two scans, uncorrected. A distance that the
  /// scans do not determine is not used.
  void update(const Pose2& odometry, const Pose2& matched, const Noise& noise, bool is_distance_determined);

  const Values& values() const { return values_; }

  template <typename Archive>
  void serialize_state(Archive& archive) {
    archive(values_, distance_variance_, turn_covariance_);
  }

 private:
  Values values_;
  double distance_variance_ = 0.05 * 0.05;
  Eigen::Matrix2d turn_covariance_ = Eigen::Vector2d(0.05 * 0.05, 0.05 * 0.05).asDiagonal();
};

}  // namespace patrol::slam
