#include "localize/imu_mount.h"

#include <limits>
#include <numbers>

#include <gtest/gtest.h>

namespace patrol::localize::imu_mount_test {
namespace {

TEST(ImuMount, OnASpinningBodyTheCentripetalForceOfTheLeverIsTakenOff) {
  ImuMount mount({{0.5, 0.0, 0.0}, Eigen::Quaterniond::Identity()});
  // 2 rad/s at 0.5 m: 2 m/s2 towards the axis.
  const InertialSample sample = mount.to_body(
      {.stamp = Time{0}, .angular_velocity_radps = {0, 0, 2.0}, .linear_acceleration_mps2 = {-2.0, 0, 9.81}});
  EXPECT_LT((sample.force_mps2 - Eigen::Vector3d(0, 0, 9.81)).norm(), 1e-12);
}

TEST(ImuMount, WhenTheSpinGrowsTheTangentialForceIsTakenOffToo) {
  ImuMount mount({{0.5, 0.0, 0.0}, Eigen::Quaterniond::Identity()});
  mount.to_body({.stamp = Time{0}});
  // 0.1 rad/s more in 10 ms: 10 rad/s2 at 0.5 m are 5 m/s2 to the left; and 0.005 m/s2 inwards.
  const InertialSample sample = mount.to_body({.stamp = std::chrono::milliseconds(10),
                                               .angular_velocity_radps = {0, 0, 0.1},
                                               .linear_acceleration_mps2 = {-0.005, 5.0, 9.81}});
  EXPECT_LT((sample.force_mps2 - Eigen::Vector3d(0, 0, 9.81)).norm(), 1e-9);
}

TEST(ImuMount, ARotatedUnitIsRotatedBack) {
  ImuMount mount({{0, 0, 0}, quaternion_from_yaw(std::numbers::pi / 2)});
  const InertialSample sample =
      mount.to_body({.stamp = Time{0}, .angular_velocity_radps = {1, 0, 0}, .linear_acceleration_mps2 = {0, 2, 0}});
  EXPECT_LT((sample.rate_radps - Eigen::Vector3d(0, 1, 0)).norm(), 1e-12);
  EXPECT_LT((sample.force_mps2 - Eigen::Vector3d(-2, 0, 0)).norm(), 1e-12);
}

TEST(ImuMount, NaNAndReadingsBeyondAnyUnitAreNotPlausible) {
  Imu imu;
  EXPECT_TRUE(is_plausible(imu));
  imu.angular_velocity_radps.x() = 36.0;
  EXPECT_FALSE(is_plausible(imu));
  imu.angular_velocity_radps.x() = std::numeric_limits<double>::quiet_NaN();
  EXPECT_FALSE(is_plausible(imu));
}

}  // namespace
}  // namespace patrol::localize::imu_mount_test
