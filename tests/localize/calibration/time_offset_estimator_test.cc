#include "localize/calibration/time_offset_estimator.h"

#include <cmath>

#include <gtest/gtest.h>

#include "core/random.h"
#include "tests/support/late_lidar.h"

namespace patrol::localize::time_offset_estimator_test {
namespace {

using test::LateLidar;
using test::walking;

Pose2 straight(double t) { return {0.7 * t, 0.0, 0.0}; }

TEST(TimeOffsetEstimator, RecoversOffsetsOfBothSigns) {
  for (const double offset_s : {-0.05, -0.02, -0.005, 0.0, 0.005, 0.02, 0.05}) {
    TimeOffsetEstimator estimator({});
    LateLidar(7, walking).run_applied(estimator, offset_s, 20);
    const TimeOffset found = estimator.at(from_seconds(20.0));
    EXPECT_LT(found.std_s, 0.0016) << offset_s << ", of which 1.5 ms are the lag of odometry";
    EXPECT_NEAR(found.value_s, offset_s, 0.001) << offset_s;
  }
}

TEST(TimeOffsetEstimator, AccountsForTheAppliedOffset) {
  TimeOffsetEstimator estimator({});
  LateLidar lidar(8, walking);
  for (int second = 2; second <= 20; ++second) {
    lidar.applied_s = 0.02 * std::min(1.0, second / 10.0);
    lidar.run(estimator, second, [](double) { return 0.02; });
  }
  EXPECT_NEAR(estimator.at(from_seconds(20.0)).value_s, 0.02, 0.001);
}

// The errors include a jitter of 1 ms; the lag of odometry, which this plant does not have, is left out.
TEST(TimeOffsetEstimator, IsConsistentOverManySeeds) {
  double sum = 0.0;
  constexpr int kSeeds = 60;
  for (std::uint64_t seed = 1; seed <= kSeeds; ++seed) {
    TimeOffsetEstimatorSettings settings;
    settings.odometry_lag_std_s = 0.0;
    TimeOffsetEstimator estimator(settings);
    const double offset_s = 0.003 * RandomStream(seed, "offset").normal(0);
    LateLidar(seed, walking, {.jitter_s = 0.001}).run(estimator, 40.0, [&](double) { return offset_s; });
    const TimeOffset found = estimator.at(from_seconds(40.0));
    sum += std::pow((found.value_s - offset_s) / found.std_s, 2);
  }
  EXPECT_GT(sum / kSeeds, 0.3);
  EXPECT_LT(sum / kSeeds, 2.0);
}

TEST(TimeOffsetEstimator, KeepsItsPriorForStraightMotionAtConstantSpeed) {
  TimeOffsetEstimatorSettings settings;
  TimeOffsetEstimator estimator(settings);
  LateLidar(9, straight).run(estimator, 60.0, [](double) { return 0.02; });
  EXPECT_GT(estimator.at(from_seconds(60.0)).std_s, 0.9 * settings.prior_std_s);
}

TEST(TimeOffsetEstimator, FollowsTheDriftOfAClock) {
  TimeOffsetEstimator estimator({});
  const auto offset_s = [](double t) { return 0.002 + 2e-5 * t; };
  LateLidar(10, walking).run(estimator, 300.0, offset_s);
  const TimeOffset found = estimator.at(from_seconds(300.0));
  EXPECT_NEAR(found.value_s, offset_s(300.0), 3.0 * found.std_s);
  EXPECT_NEAR(found.drift_s_per_s, 2e-5, 3.0 * found.drift_std_s_per_s);
  EXPECT_EQ(estimator.num_steps(), 0);
}

TEST(TimeOffsetEstimator, DetectsAStepAndStartsAgain) {
  TimeOffsetEstimator estimator({});
  LateLidar lidar(11, walking);
  lidar.run(estimator, 60.0, [](double) { return 0.0; });
  EXPECT_EQ(estimator.num_steps(), 0);
  lidar.run(estimator, 90.0, [](double) { return -0.02; });
  EXPECT_EQ(estimator.num_steps(), 1);
  EXPECT_NEAR(estimator.at(from_seconds(90.0)).value_s, -0.02, 0.002);
}

TEST(TimeOffsetEstimator, AStandingRobotChangesNothing) {
  TimeOffsetEstimatorSettings settings;
  TimeOffsetEstimator estimator(settings);
  for (int i = 0; i < 40; ++i) {
    estimator.add(
        {.sweep = {.stamp = from_seconds(0.1 * i), .duration_s = 0.1, .T_odom_begin = {}, .T_odom_end = {}},
         .match = {.map = 1, .T_local_level = {}, .covariance = Eigen::Vector3d(1e-6, 1e-6, 1e-7).asDiagonal()}});
  }
  EXPECT_EQ(estimator.num_steps(), 0);
  EXPECT_EQ(estimator.at(from_seconds(4.0)).value_s, 0.0);
  EXPECT_NEAR(estimator.at(from_seconds(4.0)).noise_std_s, settings.prior_std_s, 0.01 * settings.prior_std_s);
}

}  // namespace
}  // namespace patrol::localize::time_offset_estimator_test
