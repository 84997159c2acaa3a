#pragma once

#include <optional>
#include <utility>

#include "core/sensors/registry.h"
#include "localize/inertial_motion.h"

namespace patrol::localize {

/// Returns whether a reading is finite and within the measuring range of MEMS units.
bool is_plausible(const Imu& imu);

/// Transforms readings of an IMU with any mounting pose to the body origin: rotation and lever-arm compensation.
class ImuMount {
 public:
  explicit ImuMount(Pose3 T_body_imu) : T_body_imu_(std::move(T_body_imu)) {}

  /// Transforms a reading. Call in order of stamps, because the lever arm needs the angular acceleration.
  InertialSample to_body(const Imu& imu);

  const Eigen::Quaterniond& R_body_imu() const { return T_body_imu_.rotation; }

  template <typename Archive>
  void serialize_state(Archive& archive) {
    archive(last_rate_radps_, last_);
  }

 private:
  Pose3 T_body_imu_;
  Eigen::Vector3d last_rate_radps_ = Eigen::Vector3d::Zero();
  std::optional<Time> last_;
};

}  // namespace patrol::localize
