#pragma once

#include <Eigen/Core>

#include "core/sensors/imu.h"

namespace patrol::sim {

/// Detects from the IMU that a robot on tracks or wheels has fallen over.
class FallDetector {
 public:
  FallDetector(const Eigen::Matrix3d& R_body_imu, double tick_s) : R_body_imu_(R_body_imu), tick_s_(tick_s) {}

  /// Integrates the "up" direction with the gyroscope and corrects it slowly by the accelerometer.
  void step(const Imu& imu);

  /// Returns true once the robot has been tilted beyond 60 degrees for 0.3 s.
  bool has_fallen() const { return fallen_s_ > 0.3; }

  const Eigen::Vector3d& up_in_body() const { return up_in_body_; }

  template <typename Archive>
  void serialize_state(Archive& archive) {
    archive(up_in_body_, age_s_, fallen_s_);
  }

 private:
  Eigen::Matrix3d R_body_imu_;
  double tick_s_;
  Eigen::Vector3d up_in_body_ = Eigen::Vector3d::UnitZ();
  double age_s_ = 0.0;  ///< time since switch-on
  double fallen_s_ = 0.0;
};

}  // namespace patrol::sim
