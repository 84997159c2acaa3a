#include "localize/imu_front_end.h"

#include <limits>

#include <gtest/gtest.h>

#include "localize/inertial_filter.h"

namespace patrol::localize::imu_front_end_test {
namespace {

using namespace std::chrono_literals;
using FrontEnd = ImuFrontEnd<InertialFilter>;

InertialFilter make_filter(const InertialSample& first) {
  return {{.gyro_noise_density_radps_per_sqrt_hz = 2e-4,
           .gyro_bias_std_radps = 5e-3,
           .gyro_bias_random_walk_radps_per_sqrt_s = 1e-5,
           .accel_noise_density_mps2_per_sqrt_hz = 0.1,
           .accel_bias_std_mps2 = 0.05,
           .accel_bias_random_walk_mps2_per_sqrt_s = 1e-3,
           .position_random_walk_m_per_sqrt_m = 0.01,
           .yaw_random_walk_rad_per_sqrt_rad = 0.003},
          first};
}

FrontEnd make_front_end() {
  return {{},
          {.standstill = {.window_s = 1.0, .gyro_noise_density_radps_per_sqrt_hz = 2e-4, .foot_std_m = 3e-5},
           .buffer_s = 2.0,
           .max_extrapolation_s = 0.15}};
}

/// Reading at rest; `noise` makes it differ from others.
Imu resting(Time stamp, double noise = 0.0) {
  Imu imu{.stamp = stamp};
  imu.angular_velocity_radps = {0.0, 0.0, noise};
  imu.linear_acceleration_mps2 = {0.0, 0.0, kGravity_mps2};
  return imu;
}

FrontEnd::Step add(FrontEnd& imu, const Imu& reading) {
  const auto sample = imu.accept(reading, false);
  return sample ? imu.advance(reading.stamp, *sample, make_filter) : FrontEnd::Step::kIgnored;
}

TEST(ImuFrontEnd, RejectsImplausibleOldAndFrozenReadings) {
  FrontEnd imu = make_front_end();
  EXPECT_EQ(add(imu, resting(1s)), FrontEnd::Step::kStarted);
  EXPECT_FALSE(imu.accept(resting(1s, 1e-3), false)) << "not newer";
  EXPECT_FALSE(imu.accept(resting(2s, std::numeric_limits<double>::quiet_NaN()), false));
  EXPECT_EQ(imu.num_rejected_messages(), 2U);
  for (int i = 0; i < 10; ++i) imu.accept(resting(2s), true);
  EXPECT_FALSE(imu.accept(resting(2s), true)) << "frozen while the robot moves";
  EXPECT_TRUE(imu.accept(resting(2s), false)) << "at rest it may repeat";
}

TEST(ImuFrontEnd, WaitsForAReadingThatGivesTheTilt) {
  FrontEnd imu = make_front_end();
  Imu shaken = resting(1s);
  shaken.linear_acceleration_mps2.z() += 1.1;
  EXPECT_EQ(add(imu, shaken), FrontEnd::Step::kIgnored);
  EXPECT_FALSE(imu.filter());
  EXPECT_EQ(add(imu, resting(1004ms)), FrontEnd::Step::kStarted);
}

TEST(ImuFrontEnd, BridgesGapsAndIsSilentOnlyUntilTheNextReading) {
  FrontEnd imu = make_front_end();
  add(imu, resting(1s));
  EXPECT_EQ(add(imu, resting(1004ms)), FrontEnd::Step::kPropagated);
  EXPECT_EQ(add(imu, resting(1055ms)), FrontEnd::Step::kBridged);
  imu.coast_to(1100ms, 0.3);
  EXPECT_TRUE(imu.has_timed_out());
  EXPECT_EQ(imu.now(), Time(1100ms));
  EXPECT_NEAR(to_yaw(imu.estimate().T_odom_body.rotation), 0.045 * 0.3, 1e-9);
  add(imu, resting(1104ms));
  EXPECT_FALSE(imu.has_timed_out());
}

TEST(ImuFrontEnd, PosesAreRememberedAndExtrapolatedForALittle) {
  FrontEnd imu = make_front_end();
  EXPECT_FALSE(imu.T_odom_body_at(1s));
  add(imu, resting(1s));
  imu.remember();
  imu.coast_to(1100ms, 0.5);
  EXPECT_FALSE(imu.T_odom_body_at(999ms));
  ASSERT_TRUE(imu.T_odom_body_at(1050ms));
  EXPECT_NEAR(to_yaw(imu.T_odom_body_at(1050ms)->rotation), 0.025, 1e-9);
  ASSERT_TRUE(imu.T_odom_body_at(1200ms));
  EXPECT_NEAR(to_yaw(imu.T_odom_body_at(1200ms)->rotation), 0.1, 1e-9);
  EXPECT_FALSE(imu.T_odom_body_at(1251ms));
}

TEST(ImuFrontEnd, TheVelocityIsHeldOnceAPeriod) {
  FrontEnd imu = make_front_end();
  add(imu, resting(1s));
  EXPECT_TRUE(imu.is_velocity_limit_due(100ms));
  imu.coast_to(1090ms, 0.0);
  EXPECT_FALSE(imu.is_velocity_limit_due(100ms));
  imu.coast_to(1100ms, 0.0);
  EXPECT_TRUE(imu.is_velocity_limit_due(100ms));
}

}  // namespace
}  // namespace patrol::localize::imu_front_end_test
