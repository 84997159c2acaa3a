#pragma once

#include <deque>
#include <optional>

#include <Eigen/Geometry>

#include "core/sensors/registry.h"

namespace patrol::localize {

/// Gyro rate about the vertical, as measured, integrated over time.
class GyroYaw {
 public:
  explicit GyroYaw(const Eigen::Quaterniond& R_body_imu) : R_body_imu_(R_body_imu) {}

  /// Adds a reading; `R_odom_body` is the attitude at its stamp. Stamps must increase.
  void add(const Imu& imu, const Eigen::Quaterniond& R_odom_body);
  /// Returns the integral at a stamp of the last seconds; none outside that span or across a gap of the readings.
  std::optional<double> at(Time stamp) const;

  template <typename Archive>
  void serialize_state(Archive& archive) {
    archive(samples_);
  }

 private:
  struct Sample {
    Time stamp{};
    double rate_radps = 0.0;
    double yaw_rad = 0.0;
  };

  Eigen::Quaterniond R_body_imu_;
  std::deque<Sample> samples_;
};

}  // namespace patrol::localize
