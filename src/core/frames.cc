#include "core/frames.h"

namespace patrol {

Eigen::Quaterniond quaternion_from_rpy(double roll_rad, double pitch_rad, double yaw_rad) {
  return Eigen::AngleAxisd(yaw_rad, Eigen::Vector3d::UnitZ()) * Eigen::AngleAxisd(pitch_rad, Eigen::Vector3d::UnitY()) *
         Eigen::AngleAxisd(roll_rad, Eigen::Vector3d::UnitX());
}

Pose3 interpolate(const Pose3& a, const Pose3& b, double fraction) {
  return {a.position + fraction * (b.position - a.position), a.rotation.slerp(fraction, b.rotation)};
}

}  // namespace patrol
