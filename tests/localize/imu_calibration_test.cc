#include "localize/imu_calibration.h"

#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

#include "core/frames.h"

namespace patrol::localize::imu_calibration_test {
namespace {

const Eigen::Vector3d kUp(0.0, 0.0, 1.0);

ImuBiases biases() {
  return {.gyro_radps = {0.001, 0.002, 0.003},
          .accel_mps2 = {0.1, 0.2, 0.3},
          .gyro_covariance = Eigen::Vector3d(1e-8, 4e-8, 9e-8).asDiagonal(),
          .accel_covariance = Eigen::Vector3d(0.01, 0.04, 0.0001).asDiagonal()};
}

TEST(ImuCalibration, NamesItsParametersAsInTheTable) {
  const std::vector<CalibrationValue> values = imu_calibration(biases(), {}, Eigen::Quaterniond::Identity(), kUp);
  ASSERT_EQ(values.size(), 5U);
  constexpr auto kFirst = static_cast<std::size_t>(CalibrationParameter::kGyroXBias);
  for (std::size_t i = 0; i < values.size(); ++i) EXPECT_EQ(values[i].name, kCalibrationParameters[kFirst + i].name);
}

// The sensor is turned to the left by 90 degrees: its x axis is y of body, its y axis is -x of body.
TEST(ImuCalibration, GivesTheBiasesInTheAxesOfTheSensor) {
  const auto values = imu_calibration(biases(), {}, quaternion_from_yaw(0.5 * std::numbers::pi), kUp);
  EXPECT_NEAR(values[0].value, 0.002, 1e-12);
  EXPECT_NEAR(values[0].std, 2e-4, 1e-12);
  EXPECT_NEAR(values[1].value, -0.001, 1e-12);
  EXPECT_NEAR(values[1].std, 1e-4, 1e-12);
  EXPECT_NEAR(values[2].value, 0.2, 1e-12);
  EXPECT_NEAR(values[3].value, -0.1, 1e-12);
  EXPECT_NEAR(values[4].value, 0.3, 1e-12);
}

// Not measured at all (P = P0), the bias has the standard deviation of the data sheet; measured well, that of the
// filter.
TEST(ImuCalibration, AddsWhatThePriorOfTheFilterLacks) {
  ImuBiases measured = biases();
  measured.accel_covariance = Eigen::Vector3d(0.05 * 0.05, 0.01 * 0.01, 1e-8).asDiagonal();
  const auto values = imu_calibration(measured, {.accel_filter_prior_std_mps2 = 0.05, .accel_prior_std_mps2 = 0.2},
                                      Eigen::Quaterniond::Identity(), kUp);
  EXPECT_NEAR(values[2].std, 0.2, 1e-12);
  EXPECT_NEAR(values[3].std, std::sqrt(1e-4 + 0.04 * 0.04 * (0.04 - 0.0025)), 1e-12);
  EXPECT_NEAR(values[4].std, 1e-4, 1e-6);
}

TEST(ImuCalibration, AddsTheSystematicErrors) {
  const auto values = imu_calibration(biases(), {.gyro_systematic_std_radps = 1e-3, .accel_systematic_std_mps2 = 0.15},
                                      Eigen::Quaterniond::Identity(), kUp);
  EXPECT_NEAR(values[1].std, std::hypot(2e-4, 1e-3), 1e-12);
  for (int axis = 0; axis < 3; ++axis) {
    const double std_mps2[] = {0.1, 0.2, 0.01};
    EXPECT_NEAR(values[2 + static_cast<std::size_t>(axis)].std, std::hypot(std_mps2[axis], 0.15), 1e-12);
  }
}

TEST(ImuCalibration, AddsTheScaleOfGravityAlongTheVertical) {
  const auto values = imu_calibration(biases(), {.gyro_systematic_std_radps = 3e-4, .accel_scale_std = 0.005},
                                      Eigen::Quaterniond::Identity(), kUp);
  EXPECT_NEAR(values[0].std, std::hypot(1e-4, 3e-4), 1e-12);
  EXPECT_NEAR(values[2].std, 0.1, 1e-12);
  EXPECT_NEAR(values[4].std, std::hypot(0.01, 0.005 * 9.81), 1e-12);
}

}  // namespace
}  // namespace patrol::localize::imu_calibration_test
