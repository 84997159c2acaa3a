#pragma once

#include <ostream>

#include <Eigen/Core>
#include <gmock/gmock.h>

#include "core/frames.h"

namespace patrol {

// How GoogleTest prints poses.
inline void PrintTo(const Pose2& pose, std::ostream* out) {
  *out << '(' << pose.x << ", " << pose.y << ", " << pose.yaw << " rad)";
}
inline void PrintTo(const Pose3& pose, std::ostream* out) {
  *out << '(' << pose.position.transpose() << "; " << pose.rotation.w() << ' ' << pose.rotation.vec().transpose()
       << ')';
}

}  // namespace patrol

namespace patrol::test {

/// Angle between two rotations, 0 ... pi; a quaternion and its negative are one rotation.
inline double angle_between_rad(const Eigen::Quaterniond& a, const Eigen::Quaterniond& b) {
  return a.angularDistance(b);
}

MATCHER_P2(VectorNear, expected, tol,
           "is within " + ::testing::PrintToString(tol) + " of " + ::testing::PrintToString(expected)) {
  const double difference = (arg - expected).norm();
  *result_listener << "which differs by " << difference;
  return difference <= tol;
}

MATCHER_P3(Pose2Near, expected, tol_m, tol_rad,
           "is within " + ::testing::PrintToString(tol_m) + " m and " + ::testing::PrintToString(tol_rad) + " rad of " +
               ::testing::PrintToString(expected)) {
  const double distance_m = (arg.position() - expected.position()).norm();
  const double angle_rad = std::abs(wrap_angle(arg.yaw - expected.yaw));
  *result_listener << "which is " << distance_m << " m and " << angle_rad << " rad away";
  return distance_m <= tol_m && angle_rad <= tol_rad;
}

MATCHER_P3(Pose3Near, expected, tol_m, tol_rad,
           "is within " + ::testing::PrintToString(tol_m) + " m and " + ::testing::PrintToString(tol_rad) + " rad of " +
               ::testing::PrintToString(expected)) {
  const double distance_m = (arg.position - expected.position).norm();
  const double angle_rad = angle_between_rad(arg.rotation, expected.rotation);
  *result_listener << "which is " << distance_m << " m and " << angle_rad << " rad away";
  return distance_m <= tol_m && angle_rad <= tol_rad;
}

}  // namespace patrol::test
