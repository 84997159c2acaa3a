#include "localize/inertial_filter.h"

#include <cmath>
#include <numbers>

#include <Eigen/Eigenvalues>
#include <Eigen/Geometry>
#include <gtest/gtest.h>

namespace patrol::localize::inertial_filter_test {
namespace {

constexpr double kDt = 0.004;
const Eigen::Vector3d kAtRest(0.0, 0.0, 9.81);

InertialFilter::Settings quiet() {
  return {.gyro_noise_density_radps_per_sqrt_hz = 1e-4,
          .gyro_bias_std_radps = 0.005,
          .gyro_bias_random_walk_radps_per_sqrt_s = 1e-6,
          .accel_noise_density_mps2_per_sqrt_hz = 0.01,
          .accel_bias_std_mps2 = 0.05,
          .accel_bias_random_walk_mps2_per_sqrt_s = 1e-4,
          .position_random_walk_m_per_sqrt_m = 0.0,
          .yaw_random_walk_rad_per_sqrt_rad = 0.0};
}

TEST(InertialFilter, StartsWithTheTiltOfGravity) {
  const Eigen::Quaterniond tilt = quaternion_from_rpy(0.1, -0.2, 0.0);
  const InertialFilter filter(quiet(), {.force_mps2 = tilt.conjugate() * kAtRest});
  EXPECT_LT(filter.motion().T_odom_body.rotation.angularDistance(tilt), 1e-9);
}

TEST(InertialFilter, HalfATurnPerSecondEndsAtHalfATurn) {
  InertialFilter filter(quiet(), {.rate_radps = {0, 0, std::numbers::pi}, .force_mps2 = kAtRest});
  for (int i = 0; i < 250; ++i) filter.predict(kDt, {.rate_radps = {0, 0, std::numbers::pi}, .force_mps2 = kAtRest});
  EXPECT_NEAR(std::abs(to_yaw(filter.motion().T_odom_body.rotation)), std::numbers::pi, 1e-6);
}

TEST(InertialFilter, ConstantAccelerationGrowsAsHalfATSquared) {
  const Eigen::Vector3d force = kAtRest + Eigen::Vector3d(0.5, 0, 0);
  InertialFilter filter(quiet(), {.force_mps2 = kAtRest});
  filter.predict(kDt, {.force_mps2 = kAtRest + 2.0 * Eigen::Vector3d(0.5, 0, 0)});  // the mean of both is 0.5
  for (int i = 1; i < 500; ++i) filter.predict(kDt, {.force_mps2 = i == 1 ? Eigen::Vector3d(kAtRest) : force});
  // 2 s at 0.5 m/s2, less two half steps of the trapezoid (0.002 s each at the start).
  EXPECT_NEAR(filter.motion().T_odom_body.position.x(), 0.5 * 0.5 * 2.0 * 2.0, 0.01);
  EXPECT_NEAR(filter.motion().v_body.x(), 1.0, 0.005);
}

TEST(InertialFilter, CircleAtConstantSpeedComesBack) {
  // v = 1 m/s ahead, omega = 1 rad/s: the accelerometer reads the centripetal 1 m/s2 to the left; 2 pi
  // seconds make a circle.
  const InertialSample sample{.rate_radps = {0, 0, 1.0}, .force_mps2 = kAtRest + Eigen::Vector3d(0, 1.0, 0)};
  InertialFilter filter(quiet(), {.rate_radps = {0, 0, 1.0}, .force_mps2 = kAtRest});
  for (int i = 0; i < 50; ++i)
    filter.correct_velocity(Eigen::Vector3d(1, 0, 0) - filter.motion().v_body, {0, 0, 0}, 1e-6);
  const Eigen::Vector3d start = filter.motion().T_odom_body.position;
  const double dt = 2.0 * std::numbers::pi / 1600.0;
  for (int i = 0; i < 1600; ++i) filter.predict(dt, sample);
  EXPECT_LT((filter.motion().T_odom_body.position - start).head<2>().norm(), 0.02);
}

TEST(InertialFilter, LegsThatDoNotMoveLevelATiltedStart) {
  // The first sample came with a shock of 0.5 m/s2: 0.051 rad of wrong pitch, cured within two seconds of
  // standing.
  InertialFilter filter(quiet(), {.force_mps2 = kAtRest + Eigen::Vector3d(0.5, 0, 0)});
  for (int i = 0; i < 500; ++i) {
    filter.predict(kDt, {.force_mps2 = kAtRest});
    filter.correct_velocity(-filter.motion().v_body, {0, 0, -0.3}, 1e-4);
  }
  const Eigen::Vector3d up = filter.up_in_body();
  EXPECT_LT(std::acos(std::min(1.0, up.z())), 0.002);
}

TEST(InertialFilter, BiasReadingMovesBiasByTheRatioOfVariances) {
  InertialFilter filter(quiet(), {.force_mps2 = kAtRest});
  const double prior = 0.005 * 0.005;
  filter.correct_gyro_bias(Eigen::Vector3d(0, 0, 0.003), Eigen::Vector3d::Constant(prior));
  EXPECT_NEAR(filter.gyro_bias_radps().z(), 0.0015, 1e-12);
}

// A bias found late explains half a meter of the way so far; odom is dead reckoning and stays where it is (REP 105).
TEST(InertialFilter, BiasReadingMovesNeitherPositionNorHeading) {
  InertialFilter filter(quiet(), {.rate_radps = {0, 0, 0.01}, .force_mps2 = kAtRest});
  for (int i = 0; i < 5000; ++i) {  // 20 s at 1 m/s
    filter.predict(kDt, {.rate_radps = {0, 0, 0.01}, .force_mps2 = kAtRest});
    filter.correct_velocity(Eigen::Vector3d(1, 0, 0) - filter.motion().v_body, {0, 0, 0}, 1e-4);
  }
  const Pose3 before = filter.motion().T_odom_body;
  const Eigen::Matrix3d covariance = filter.planar_covariance();
  filter.correct_gyro_bias({0, 0, 0.01}, Eigen::Vector3d::Constant(1e-8));
  EXPECT_NEAR(filter.gyro_bias_radps().z(), 0.01, 1e-4);
  EXPECT_LT((filter.motion().T_odom_body.position - before.position).norm(), 1e-12);
  EXPECT_LT(std::abs(to_yaw(filter.motion().T_odom_body.rotation) - to_yaw(before.rotation)), 1e-6);
  EXPECT_NEAR(filter.planar_covariance()(2, 2), covariance(2, 2), 1e-3 * covariance(2, 2))
      << "nor does it grow surer of them";
}

TEST(InertialFilter, VelocityCorrectionsDoNotConstrainYaw) {
  InertialFilter filter(quiet(), {.force_mps2 = kAtRest});
  for (int i = 0; i < 500; ++i) {
    const double turn = i < 250 ? 0.3 : -0.5, tilt = 0.2 * std::sin(0.1 * i);
    filter.predict(kDt, {.rate_radps = {tilt, -tilt, turn}, .force_mps2 = kAtRest});
    const double before = filter.planar_covariance()(2, 2);
    filter.correct_velocity(-filter.motion().v_body, {0, 0, 0}, 1e-4);
    EXPECT_GT(filter.planar_covariance()(2, 2), 0.9999 * before);
  }
}

TEST(InertialFilter, CovarianceStaysSymmetricAndPositive) {
  InertialFilter filter(quiet(), {.force_mps2 = kAtRest});
  for (int i = 0; i < 5000; ++i) {
    const double t = kDt * i;
    filter.predict(kDt, {.rate_radps = {0.3 * std::sin(9 * t), 0.4 * std::cos(17 * t), 0.5}, .force_mps2 = kAtRest});
    filter.correct_velocity(Eigen::Vector3d(0.8, 0, 0) - filter.motion().v_body, {0.01, 0, -0.3}, 2e-3);
  }
  const auto& P = filter.covariance();
  EXPECT_LT((P - P.transpose()).cwiseAbs().maxCoeff(), 1e-15);
  EXPECT_GT(Eigen::SelfAdjointEigenSolver<InertialFilter::Covariance>(P).eigenvalues().minCoeff(), -1e-12);
}

TEST(InertialFilter, CoastingGrowsYawUncertaintyWithTime) {
  InertialFilter filter(quiet(), {.force_mps2 = kAtRest});
  for (int i = 0; i < 125; ++i) filter.coast(kDt, 0.2);
  EXPECT_NEAR(to_yaw(filter.motion().T_odom_body.rotation), 0.1, 1e-9);
  EXPECT_GT(filter.planar_covariance()(2, 2), 0.5 * 0.05 * 0.05 * 0.99);
}

}  // namespace
}  // namespace patrol::localize::inertial_filter_test
