#include "localize/calibration/odometry_calibrator.h"

#include <cmath>

#include <Eigen/Geometry>
#include <gtest/gtest.h>

#include "core/random.h"

namespace patrol::localize::odometry_calibrator_test {
namespace {

const Eigen::Vector2d kLidar(0.2, 0.05);

struct Plant {
  double lidar_yaw_rad = 0.0;   ///< actual minus nominal
  double distance_scale = 1.0;  ///< actual / odometry
  double rotation_scale = 1.0;
  double gyro_bias_radps = 0.0, gyro_scale = 1.0;
};

/// Drives a path of arcs and lines at 10 Hz, with noise of matches and odometry; maps of 60 scans.
void drive(OdometryCalibrator& calibrator, const Plant& plant, std::uint64_t seed, double duration_s, bool turns) {
  const RandomStream random(seed, "drive");
  Pose2 truth, odom;
  double gyro_yaw_rad = 0.0;
  for (int k = 0; k * 0.1 < duration_s; ++k) {
    const double t = 0.1 * k;
    const auto n = random.normals(static_cast<std::uint64_t>(k)), m = random.normals(static_cast<std::uint64_t>(k), 1);
    const Eigen::Vector3d velocity(0.7, 0.0, turns ? 0.5 * std::sin(0.3 * t) : 0.0);
    const Pose2 step{0.1 * velocity.x(), 0.0, 0.1 * velocity.z()};
    truth = truth * step;
    odom = odom * Pose2{step.x / plant.distance_scale + 0.001 * n[0], 0.001 * n[1],
                        step.yaw / plant.rotation_scale + 0.0002 * n[2]};
    gyro_yaw_rad += step.yaw / plant.gyro_scale + 0.1 * plant.gyro_bias_radps + 0.0001 * n[3];
    // The level scan is turned about the lidar against its actual yaw.
    const Eigen::Rotation2Dd R(-plant.lidar_yaw_rad);
    const Eigen::Vector2d shift = kLidar - R * kLidar;
    const Pose2 T_nominal_actual{shift.x(), shift.y(), -plant.lidar_yaw_rad};
    Pose2 matched = truth * T_nominal_actual.inverse();
    matched.x += 0.001 * m[0], matched.y += 0.001 * m[1], matched.yaw += 0.0003 * m[2];
    calibrator.add({.sweep = {.stamp = from_seconds(t),
                              .duration_s = 0.1,
                              .T_odom_begin = odom * Pose2{-step.x, 0.0, -step.yaw},
                              .T_odom_end = odom},
                    .match = {.map = k / 60,
                              .T_local_level = matched,
                              .covariance = Eigen::Vector3d(1e-6, 1e-6, 1e-7).asDiagonal()}},
                   0.0, gyro_yaw_rad);
  }
}

OdometryCalibratorSettings without_biases() {
  OdometryCalibratorSettings settings;
  settings.lateral_bias_std_rad = settings.distance_bias_std = settings.matched_rate_bias_std_radps =
      settings.matched_rotation_bias_std = 0.0;
  return settings;
}

void expect_within_3_sigma(const ScalarEstimate& estimate, double expected, const char* what) {
  EXPECT_NEAR(estimate.value, expected, 3.0 * estimate.std) << what;
}

TEST(OdometryCalibrator, RecoversAllParameters) {
  const Plant plant{.lidar_yaw_rad = 0.006,
                    .distance_scale = 1.01,
                    .rotation_scale = 0.995,
                    .gyro_bias_radps = 0.003,
                    .gyro_scale = 1.004};
  OdometryCalibrator calibrator(without_biases(), kLidar);
  drive(calibrator, plant, 1, 200.0, true);
  expect_within_3_sigma(calibrator.lidar_yaw_rad(), 0.006, "lidar yaw");
  expect_within_3_sigma(calibrator.distance_scale(), 1.01, "distance scale");
  expect_within_3_sigma(calibrator.rotation_scale(), 0.995, "rotation scale");
  expect_within_3_sigma(calibrator.gyro_bias_radps(), 0.003, "gyro bias");
  expect_within_3_sigma(calibrator.gyro_scale(), 1.004, "gyro scale");
  EXPECT_LT(calibrator.lidar_yaw_rad().std, 0.001);
  EXPECT_LT(calibrator.distance_scale().std, 0.001);
  EXPECT_LT(calibrator.rotation_scale().std, 0.002);
  EXPECT_LT(calibrator.gyro_bias_radps().std, 3e-4);
  EXPECT_LT(calibrator.gyro_scale().std, 0.002);
}

TEST(OdometryCalibrator, IsConsistentOverManySeeds) {
  constexpr int kSeeds = 40;
  Eigen::Matrix<double, 5, 1> sum = Eigen::Matrix<double, 5, 1>::Zero();
  for (std::uint64_t seed = 1; seed <= kSeeds; ++seed) {
    const RandomStream random(seed, "plant");
    const Plant plant{.lidar_yaw_rad = 0.005 * random.normal(0),
                      .distance_scale = 1.0 + 0.01 * random.normal(1),
                      .rotation_scale = 1.0 + 0.005 * random.normal(2),
                      .gyro_bias_radps = 0.002 * random.normal(3),
                      .gyro_scale = 1.0 + 0.005 * random.normal(4)};
    OdometryCalibrator calibrator(without_biases(), kLidar);
    drive(calibrator, plant, seed, 150.0, true);
    const auto squared = [](const ScalarEstimate& estimate, double expected) {
      return std::pow((estimate.value - expected) / estimate.std, 2);
    };
    sum += Eigen::Matrix<double, 5, 1>(squared(calibrator.lidar_yaw_rad(), plant.lidar_yaw_rad),
                                       squared(calibrator.distance_scale(), plant.distance_scale),
                                       squared(calibrator.rotation_scale(), plant.rotation_scale),
                                       squared(calibrator.gyro_bias_radps(), plant.gyro_bias_radps),
                                       squared(calibrator.gyro_scale(), plant.gyro_scale));
  }
  for (const double nees : sum / kSeeds) {
    EXPECT_GT(nees, 0.2);
    EXPECT_LT(nees, 2.0);
  }
}

TEST(OdometryCalibrator, MeasuresTheRecentGyroBiasOncePerInterval) {
  const Plant plant{.gyro_bias_radps = 0.003, .gyro_scale = 1.004};
  OdometryCalibrator calibrator(without_biases(), kLidar);
  drive(calibrator, plant, 1, 60.0, true);
  const std::optional<ScalarEstimate> bias = calibrator.take_recent_gyro_bias();
  ASSERT_TRUE(bias);
  EXPECT_LT(bias->std, 5e-4);
  expect_within_3_sigma(*bias, plant.gyro_bias_radps, "recent bias");
  EXPECT_FALSE(calibrator.take_recent_gyro_bias());
}

TEST(OdometryCalibrator, LeavesTheRotationScaleOpenOnAStraightLine) {
  const OdometryCalibratorSettings settings = without_biases();
  OdometryCalibrator calibrator(settings, kLidar);
  drive(calibrator, {.rotation_scale = 1.01}, 3, 100.0, false);
  EXPECT_GT(calibrator.rotation_scale().std, 0.8 * settings.prior_rotation_scale_std);
  EXPECT_GT(calibrator.gyro_scale().std, 0.8 * settings.prior_gyro_scale_std);
  EXPECT_LT(calibrator.gyro_bias_radps().std, 1e-3);
}

}  // namespace
}  // namespace patrol::localize::odometry_calibrator_test
