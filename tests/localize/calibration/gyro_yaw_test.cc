#include "localize/calibration/gyro_yaw.h"

#include <gtest/gtest.h>

#include "core/frames.h"

namespace patrol::localize::gyro_yaw_test {
namespace {

Imu turning(double t, double rate_radps) {
  return {.stamp = from_seconds(t),
          .angular_velocity_radps = {0.0, 0.0, rate_radps},
          .linear_acceleration_mps2 = {0.0, 0.0, 9.81}};
}

TEST(GyroYaw, IntegratesBetweenReadings) {
  GyroYaw gyro(Eigen::Quaterniond::Identity());
  for (int k = 0; k <= 100; ++k) gyro.add(turning(0.01 * k, 0.5), Eigen::Quaterniond::Identity());
  EXPECT_NEAR(*gyro.at(from_seconds(0.755)) - *gyro.at(from_seconds(0.25)), 0.5 * 0.505, 1e-9);
  EXPECT_FALSE(gyro.at(from_seconds(1.1)));
}

TEST(GyroYaw, ProjectsATiltedGyroOnTheVertical) {
  GyroYaw gyro(Eigen::Quaterniond::Identity());
  const Eigen::Quaterniond upside_down = quaternion_from_rpy(3.14159265358979, 0.0, 0.0);
  for (int k = 0; k <= 10; ++k) gyro.add(turning(0.01 * k, 0.5), upside_down);
  EXPECT_NEAR(*gyro.at(from_seconds(0.1)), -0.05, 1e-9);
}

TEST(GyroYaw, StartsAgainAfterAGap) {
  GyroYaw gyro(Eigen::Quaterniond::Identity());
  gyro.add(turning(0.0, 0.5), Eigen::Quaterniond::Identity());
  gyro.add(turning(0.5, 0.5), Eigen::Quaterniond::Identity());
  EXPECT_FALSE(gyro.at(from_seconds(0.2)));
}

}  // namespace
}  // namespace patrol::localize::gyro_yaw_test
