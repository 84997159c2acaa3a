#include "studies/landmark_world.h"

#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

#include "core/geometry/angles.h"
#include "tests/support/moments.h"

namespace patrol::studies::landmark_world_test {
namespace {

double distance_m(const LandmarkRun& run) {
  double way = 0.0;
  for (std::size_t k = 1; k < run.truth.size(); ++k)
    way += (run.truth[k].position() - run.truth[k - 1].position()).norm();
  return way;
}

TEST(GardenWorld, OneLapOfARadiusOf7MetersIs44MetersAndEndsWhereItBegan) {
  for (const bool is_circle : {true, false}) {
    const LandmarkRun run = simulate(garden_world("S5", is_circle), 1);
    EXPECT_NEAR(run.truth.back().position().norm(), 0.0, is_circle ? 0.15 : 0.3);
    if (is_circle) {
      EXPECT_NEAR(distance_m(run), 2.0 * std::numbers::pi * 7.0, 0.15);
    }
  }
}

TEST(GardenWorld, OdometryErrsByTheStatedNoiseAndByABiasOf2DegreesPerSecond) {
  const LandmarkWorld world = garden_world("S5", true);
  test::Moments speed, turn;
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    const LandmarkRun run = simulate(world, seed);
    for (std::size_t k = 0; k < run.odometry.size(); ++k) {
      speed.add(run.odometry[k].x() - world.controls[k].x());
      turn.add(run.odometry[k].y() - world.controls[k].y());
    }
  }
  const double count = speed.count;  // means and deviations within 4 of their standard errors
  EXPECT_NEAR(speed.mean(), 0.0, 4.0 * 0.1 / std::sqrt(count));
  EXPECT_NEAR(speed.std(), 0.1, 4.0 * 0.1 / std::sqrt(2.0 * count));
  EXPECT_NEAR(turn.mean(), 2.0 * kDegree, 4.0 * 5.0 * kDegree / std::sqrt(count));
  EXPECT_NEAR(turn.std(), 5.0 * kDegree, 4.0 * 5.0 * kDegree / std::sqrt(2.0 * count));
}

TEST(GardenWorld, EveryObservationIsOfALandmarkWithin10MetersAndErrsByHalfAMeterAnd5Degrees) {
  const LandmarkWorld world = garden_world("M", true);
  const LandmarkRun run = simulate(world, 3);
  test::Moments range, bearing;
  for (std::size_t k = 0; k < run.observations.size(); ++k) {
    for (const RangeBearing& sight : run.observations[k]) {
      const PredictedObservation truth =
          predict_observation(run.truth[k], world.landmarks_m[static_cast<std::size_t>(sight.landmark)]);
      EXPECT_LE(truth.observation.x(), 10.0);
      range.add(sight.range_m - truth.observation.x());
      bearing.add(wrap_angle(sight.bearing_rad - truth.observation.y()));
    }
  }
  EXPECT_GT(range.count, 5000);
  EXPECT_NEAR(range.std(), 0.5, 0.02);
  EXPECT_NEAR(bearing.std(), 5.0 * kDegree, 0.02 * 5.0 * kDegree * 2.0);
}

TEST(CampusWorld, TheCarSteersAtMost30DegreesAnd20DegreesPerSecondAndDrives600Meters) {
  const LandmarkWorld world = campus_world(false, 3.0, 8000);
  ASSERT_EQ(world.landmarks_m.size(), 31u);
  for (std::size_t k = 0; k < world.controls.size(); ++k) {
    EXPECT_LE(std::abs(world.controls[k].y()), 30.0 * kDegree + 1e-12);
    if (k > 0) {
      EXPECT_LE(std::abs(world.controls[k].y() - world.controls[k - 1].y()), 20.0 * kDegree * 0.025 + 1e-12);
    }
  }
  const LandmarkRun run = simulate(world, 1);
  EXPECT_EQ(run.truth.size(), 1000u);
  EXPECT_NEAR(distance_m(run), 600.0, 2.0);  // chords of 0.6 m, the first step left out
}

TEST(CampusWorld, ThePathStaysWithin100By80MetersAndIsClockwise) {
  const LandmarkWorld world = campus_world(false, 3.0, 8000);
  const LandmarkRun run = simulate(world, 1);
  Eigen::AlignedBox2d extent;
  double turned_rad = 0.0;
  for (std::size_t k = 0; k < run.truth.size(); ++k) {
    extent.extend(run.truth[k].position());
    if (k > 0) turned_rad += wrap_angle(run.truth[k].yaw - run.truth[k - 1].yaw);
  }
  EXPECT_LE(extent.diagonal().norm(), std::hypot(100.0, 80.0));
  EXPECT_LT(turned_rad, -2.0 * std::numbers::pi);
}

TEST(LandmarkWorld, TheSameSeedGivesTheSameRunAndSwitchingTheBiasOffChangesNoOtherSample) {
  const LandmarkRun with = simulate(campus_world(true, 3.0, 800), 7),
                    without = simulate(campus_world(false, 3.0, 800), 7);
  for (std::size_t k = 0; k < with.odometry.size(); ++k) {
    EXPECT_NEAR(with.odometry[k].x() - without.odometry[k].x(), 0.3, 1e-12);
    EXPECT_NEAR(with.odometry[k].y() - without.odometry[k].y(), 2.0 * kDegree, 1e-12);
    ASSERT_EQ(with.observations[k].size(), without.observations[k].size());
    for (std::size_t i = 0; i < with.observations[k].size(); ++i)
      EXPECT_EQ(with.observations[k][i].range_m, without.observations[k][i].range_m);
  }
}

}  // namespace
}  // namespace patrol::studies::landmark_world_test
