#include "localize/track_filter.h"

#include <cmath>

#include <Eigen/Eigenvalues>
#include <gtest/gtest.h>

namespace patrol::localize::track_filter_test {
namespace {

constexpr double kDt = 0.004;
const InertialSample kAtRest{.force_mps2 = {0.0, 0.0, 9.81}};

TrackFilter::Settings quiet() {
  return {.gyro_noise_density_radps_per_sqrt_hz = 1e-4,
          .gyro_bias_std_radps = 1e-3,
          .gyro_bias_random_walk_radps_per_sqrt_s = 1e-6,
          .accel_noise_density_mps2_per_sqrt_hz = 0.02,
          .accel_bias_std_mps2 = 0.01,
          .accel_bias_random_walk_mps2_per_sqrt_s = 1e-4,
          .yaw_random_walk_rad_per_sqrt_rad = 0.0,
          .scale_std = 0.02,
          .slip_correlation_m = 2.0,
          .icr_x_std_m = 0.05,
          .icr_y_std_m = 0.02,
          .icr_correlation_rad = 2.0,
          .turn_center_x_m = 0.0,
          .height_m = 0.0};
}

/// Steady at a speed for a time, belts heard each 20 ms.
void drive(TrackFilter& filter, double track_mps, double duration_s, double slip_std) {
  for (int step = 1; step <= std::lround(duration_s / kDt); ++step) {
    filter.predict(kDt, kAtRest);
    if (step % 5 != 0) continue;
    filter.propagate_slip(std::abs(track_mps) * 0.02, 0.0, slip_std);
    filter.correct_speed(0.02, track_mps, filter.motion(), {0.005, 0.005, 0.005});
  }
}

TEST(TrackFilter, AScaleOfTwoPercentLeavesTwoPercentOfTheDistance) {
  TrackFilter filter(quiet(), kAtRest);
  filter.set_origin();
  drive(filter, 0.5, 20.0, 0.0);
  const double std = std::sqrt(filter.covariance()(0, 0));
  EXPECT_NEAR(std, 0.02 * filter.motion().T_odom_body.position.x(), 0.15 * std);
}

TEST(TrackFilter, DecorrelatingSlipGrowsWithTheRootOfTheDistance) {
  TrackFilter::Settings settings = quiet();
  settings.scale_std = 0.0;
  TrackFilter filter(settings, kAtRest);
  filter.set_origin();
  drive(filter, 0.5, 80.0, 0.03);
  // The integral of a Gauss-Markov process over a way s much longer than its length L: sigma sqrt(2 L (s - L)), and
  // heading's.
  const double way = filter.motion().T_odom_body.position.x();
  EXPECT_NEAR(std::sqrt(filter.covariance()(0, 0)), 0.03 * std::sqrt(2.0 * 2.0 * (way - 2.0)), 0.03);
}

TEST(TrackFilter, AStandstillsBiasMovesNeitherPositionNorHeading) {
  TrackFilter filter(quiet(), kAtRest);
  drive(filter, 0.5, 2.0, 0.02);
  const Pose3 before = filter.motion().T_odom_body;
  filter.correct_gyro_bias({0.0, 0.0, 0.0008}, Eigen::Vector3d::Constant(1e-10));
  EXPECT_EQ(filter.motion().T_odom_body.position, before.position);
  // Roll and pitch move with the bias: of the second order that is yaw.
  EXPECT_NEAR(to_yaw(filter.motion().T_odom_body.rotation), to_yaw(before.rotation), 1e-7);
  EXPECT_NEAR(filter.gyro_bias_radps().z(), 0.0008, 1e-6);
}

// After 500 m each reading of the belts still tells a little of scale and slip. A hundred-thousandth of the way would
// be 5 mm.
TEST(TrackFilter, NoTrackReadingMovesThePositionAtAnyDistance) {
  TrackFilter filter(quiet(), kAtRest);
  filter.set_origin();
  drive(filter, 1.0, 500.0, 0.03);
  const Pose3 before = filter.motion().T_odom_body;
  for (const double surprise_mps : {0.02, -0.02, 0.1, -0.1}) {
    filter.correct_speed(0.02, 1.0 + surprise_mps, filter.motion(), {0.005, 0.005, 0.005});
  }
  EXPECT_EQ(filter.motion().T_odom_body.position, before.position);
}

// By the IMU alone it has gone 0.2 m/s for a second, and slid 0.3 m/s in truth: the belts that hold again put the 10 cm
// right.
TEST(TrackFilter, TheImuDriftDuringSlipIsCorrected) {
  TrackFilter filter(quiet(), kAtRest);
  filter.set_origin();
  drive(filter, 0.2, 20.0, 0.02);
  filter.start_slip(0.2, 0.0);
  const double lost_m = filter.motion().T_odom_body.position.x();
  for (int step = 0; step < 250; ++step) filter.predict(kDt, kAtRest);
  filter.end_slip(0.3, 0.02);
  drive(filter, 0.3, 1.0, 0.02);
  EXPECT_NEAR(filter.motion().T_odom_body.position.x() - lost_m, 0.3 + 0.3, 0.03);
}

TEST(TrackFilter, CovarianceStaysPositiveThroughDriveAndLossOfTraction) {
  TrackFilter filter(quiet(), kAtRest);
  drive(filter, 0.5, 5.0, 0.02);
  filter.start_slip(0.2, 0.1);
  filter.predict(kDt, kAtRest);
  filter.end_slip(0.5, 0.02);
  drive(filter, 0.5, 5.0, 0.02);
  const Eigen::SelfAdjointEigenSolver<TrackFilter::Covariance> solver(filter.covariance());
  EXPECT_GT(solver.eigenvalues().minCoeff(), -1e-12);
}

TEST(TrackFilter, AnIcrFiveCentimetersBehindMovesTheBodyLaterally) {
  TrackFilter filter(quiet(), kAtRest);
  const InertialSample turning{.rate_radps = {0, 0, 0.5}, .force_mps2 = {0, 0, 9.81}};
  for (int step = 1; step <= 250; ++step) {
    filter.predict(kDt, turning);
    if (step % 5 == 0) filter.correct_speed(0.02, 0.0, filter.motion(), {0.005, 0.005, 0.005});
  }
  // Turning on the spot by 0.5 rad/s, 0.05 m of center leave 0.025 m/s to the left, and 0.02 m leave 0.01 m/s ahead.
  EXPECT_NEAR(std::sqrt(filter.systematic_velocity_variance().y()), 0.025, 0.005);
  EXPECT_NEAR(std::sqrt(filter.systematic_velocity_variance().x()), 0.010, 0.002);
}

}  // namespace
}  // namespace patrol::localize::track_filter_test
