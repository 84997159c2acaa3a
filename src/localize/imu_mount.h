#pragma once

#include <optional>

#include "core/sensors/registry.h"
#include "localize/inertial_motion.h"

namespace patrol::localize {

/// Within what a MEMS unit can read at all, and finite.
bool is_plausible(const Imu& imu);

/// Brings readings of a unit mounted anywhere to the body's origin: turned, and without what its lever arm adds.
class ImuMount {
 public:
  explicit ImuMount(const Pose3& T_body_imu) : T_body_imu_(T_body_imu) {}

  /// In order of stamps: the lever arm needs the change of the rate.
  InertialSample to_body(const Imu& imu);

 private:
  Pose3 T_body_imu_;
  Eigen::Vector3d last_rate_radps_ = Eigen::Vector3d::Zero();
  std::optional<Time> last_;
};

}  // namespace patrol::localize
