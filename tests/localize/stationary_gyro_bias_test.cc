#include "localize/stationary_gyro_bias.h"

#include <cmath>

#include <Eigen/Geometry>
#include <gtest/gtest.h>

namespace patrol::localize::stationary_gyro_bias_test {
namespace {

constexpr double kSmallAngleTol = 1e-6;  // rad/s; the rigid fit is linear in angles of a milliradian

/// A trunk that sways by `yaw(t)` over four feet that stay; the gyro reads its rate and a bias.
std::optional<GyroBiasMeasurement> stand(const std::function<double(double)>& yaw, const Eigen::Vector3d& bias,
                                         const std::function<double(double)>& slip = nullptr) {
  StationaryGyroBiasEstimator meter(
      {.window_s = 1.0, .gyro_noise_density_radps_per_sqrt_hz = 1e-4, .foot_std_m = 1e-5});
  for (int tick = 0; tick <= 250; ++tick) {
    const double t = 0.004 * tick;
    StanceFeet feet;
    for (int leg = 0; leg < kNumLegs; ++leg) {
      const Eigen::Vector3d on_ground(leg < 2 ? 0.19 : -0.19, leg % 2 == 0 ? 0.13 : -0.13, -0.3);
      feet.push_back({.leg = leg, .p_contact = Eigen::AngleAxisd(-yaw(t), Eigen::Vector3d::UnitZ()) * on_ground});
    }
    if (slip) feet.feet[0].p_contact.x() += slip(t);
    const double rate = (yaw(t + 1e-5) - yaw(t - 1e-5)) / 2e-5;
    if (const auto reading = meter.add(from_seconds(t), feet, Eigen::Vector3d(0, 0, rate) + bias)) return reading;
  }
  return std::nullopt;
}

TEST(StationaryGyroBiasEstimator, StillTrunkReadsTheBiasExactly) {
  const Eigen::Vector3d bias(0.003, -0.002, 0.004);
  const auto reading = stand([](double) { return 0.0; }, bias);
  ASSERT_TRUE(reading);
  EXPECT_LT((reading->bias_radps - bias).norm(), 1e-12);
}

TEST(StationaryGyroBiasEstimator, SwayOfFiveMilliradiansIsNotTakenForBias) {
  const Eigen::Vector3d bias(0.0, 0.0, 0.004);
  const auto reading = stand([](double t) { return 0.005 * std::sin(1.5 * t); }, bias);
  ASSERT_TRUE(reading);
  EXPECT_LT((reading->bias_radps - bias).norm(), 20.0 * kSmallAngleTol);
}

TEST(StationaryGyroBiasEstimator, VarianceIsThatOfGyroNoiseAndFeet) {
  const auto reading = stand([](double) { return 0.0; }, Eigen::Vector3d::Zero());
  // Span between the means of the ends: 0.8 s. Yaw: 4 feet at 0.19, 0.13 m have a moment of 4 * 0.053 m2.
  const double gyro = 1e-4 * 1e-4 / 0.8, feet = 2.0 * 1e-5 * 1e-5 / (4.0 * (0.19 * 0.19 + 0.13 * 0.13)) / (0.8 * 0.8);
  EXPECT_NEAR(reading->variance.z(), gyro + feet, 0.02 * (gyro + feet));
}

TEST(StationaryGyroBiasEstimator, FootThatSlipsFiveMillimetersSpoilsTheWindow) {
  EXPECT_FALSE(stand([](double) { return 0.0; }, Eigen::Vector3d::Zero(), [](double t) { return 0.005 * t; }));
}

TEST(StationaryGyroBiasEstimator, ARotatingRobotIsNotAtRest) {
  EXPECT_FALSE(stand([](double t) { return 0.1 * t; }, Eigen::Vector3d::Zero()));
}

}  // namespace
}  // namespace patrol::localize::stationary_gyro_bias_test
