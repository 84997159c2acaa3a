#pragma once

#include <functional>

#include <Eigen/Core>

#include "core/geometry/angles.h"
#include "localize/track_odometry.h"
#include "tests/support/tracked_drive.h"

namespace patrol::localize {

/// Messages that are delivered at a time.
struct Channels {
  bool imu = true, ticks = true;
};
using Outage = std::function<Channels(double time_s)>;

inline void run(test::TrackedDrive& drive, TrackOdometry& odometry, double until_s, const Outage& outage = nullptr) {
  while (to_seconds(drive.now()) < until_s) {
    drive.step();
    const Channels on = outage ? outage(to_seconds(drive.now())) : Channels{};
    if (on.imu) odometry.add(drive.imu());
    if (on.ticks && drive.has_ticks()) odometry.add(drive.ticks());
  }
}

/// Estimate less truth: x, y, yaw. Odom starts where the robot has stood, which is the world's origin.
inline Eigen::Vector3d planar_error(const TrackOdometry& odometry, const test::TrackedDrive& drive) {
  const Pose2 estimate = to_pose2(odometry.estimate()->T_odom_body), truth = to_pose2(drive.T_world_body());
  return {estimate.x - truth.x, estimate.y - truth.y, wrap_angle(estimate.yaw - truth.yaw)};
}

/// Settings for the IMU of the plant's defaults, which is better than that of the data sheet.
inline TrackOdometrySettings for_plant() { return {.gyro_bias_std_radps = 5e-3, .accel_bias_std_mps2 = 0.05}; }

}  // namespace patrol::localize
