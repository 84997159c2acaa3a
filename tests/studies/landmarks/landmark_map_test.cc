#include "studies/landmarks/landmark_map.h"

#include <cmath>
#include <numbers>

#include <Eigen/LU>
#include <gtest/gtest.h>

#include "core/random.h"
#include "tests/support/pose_near.h"

namespace patrol::studies::landmark_map_test {
namespace {

using test::VectorNear;

constexpr double kExactTol = 1e-12;
const RangeBearingNoise kNoise{.range_std_m = 0.5, .bearing_std_rad = 0.1};

Eigen::Matrix2d diagonal(double x, double y) { return Eigen::Vector2d(x, y).asDiagonal(); }

// 4 m away: 0.5 m along the line of sight, 4 x 0.1 = 0.4 m across.
TEST(LandmarkMap, FirstObservationHasTheSensorVarianceAlongAndAcross) {
  LandmarkMap map;
  map.update(0, {}, {.range_m = 4.0, .bearing_rad = 0.0}, kNoise);
  EXPECT_THAT(map.at(0).mean_m, VectorNear(Eigen::Vector2d(4.0, 0.0), kExactTol));
  EXPECT_LT((map.at(0).covariance - diagonal(0.25, 0.16)).norm(), kExactTol);
  map.update(1, {1.0, 2.0, 0.5 * std::numbers::pi}, {.range_m = 4.0, .bearing_rad = 0.0}, kNoise);
  EXPECT_THAT(map.at(1).mean_m, VectorNear(Eigen::Vector2d(1.0, 6.0), kExactTol));
  EXPECT_LT((map.at(1).covariance - diagonal(0.16, 0.25)).norm(), kExactTol);
}

// The same sight again and again: the mean stays, and the filter is the mean of n.
TEST(LandmarkMap, VarianceFallsAsOneOverN) {
  LandmarkMap map;
  for (int n = 1; n <= 100; ++n) {
    map.update(0, {}, {.range_m = 4.0, .bearing_rad = 0.0}, kNoise);
    EXPECT_LT((n * map.at(0).covariance - diagonal(0.25, 0.16)).norm(), n * kExactTol) << n;
  }
  EXPECT_THAT(map.at(0).mean_m, VectorNear(Eigen::Vector2d(4.0, 0.0), kExactTol));
}

// Along the line of sight the filter is linear: 4.0 and 4.6 make 4.3, and 4.9 a third of the way on, 4.5.
TEST(LandmarkMap, MeanOfThreeRangesIsTheirAverage) {
  LandmarkMap map;
  for (const double range_m : {4.0, 4.6, 4.9}) map.update(0, {}, {.range_m = range_m, .bearing_rad = 0.0}, kNoise);
  EXPECT_NEAR(map.at(0).mean_m.x(), 4.5, kExactTol);
}

TEST(LandmarkMap, ANumberBeyondAllLeavesTheOnesBetweenUnseen) {
  LandmarkMap map;
  EXPECT_FALSE(map.has(0));
  map.update(2, {}, {.range_m = 4.0, .bearing_rad = 0.0}, kNoise);
  EXPECT_EQ(map.landmarks().size(), 3U);
  EXPECT_FALSE(map.has(0) || map.has(1));
  EXPECT_TRUE(map.has(2));
  EXPECT_FALSE(map.has(3));
}

// A landmark that is known for certain, 5 m ahead, seen 1 m too far and 0.2 rad to the left: (1 / 0.5)^2 + (0.2 /
// 0.1)^2 = 8, and S = R.
TEST(LandmarkInnovation, OfACertainLandmarkTwoDeviationsOffInBothIsEight) {
  const Landmark landmark{.mean_m = {5.0, 0.0}, .covariance = Eigen::Matrix2d::Zero(), .is_observed = true};
  const LandmarkInnovation fit = landmark_innovation({}, landmark, {.range_m = 6.0, .bearing_rad = 0.2}, kNoise);
  EXPECT_NEAR(fit.squared_distance, 8.0, kExactTol);
  EXPECT_NEAR(fit.log_density(), -4.0 - std::log(0.5 * 0.1), kExactTol);
}

// An uncertain one: S = 0.75 + 0.25 = 1 along, and (0.48 + 0.16) / 16 = 0.04 across, at 4 m.
TEST(LandmarkInnovation, AddsTheLandmarksVarianceToTheSensors) {
  const Landmark landmark{.mean_m = {4.0, 0.0}, .covariance = diagonal(0.75, 0.48), .is_observed = true};
  const LandmarkInnovation fit = landmark_innovation({}, landmark, {.range_m = 6.0, .bearing_rad = 0.2}, kNoise);
  EXPECT_NEAR(fit.squared_distance, 4.0 + 1.0, kExactTol);
  EXPECT_NEAR(fit.log_density(), -2.5 - 0.5 * std::log(0.04), kExactTol);
}

TEST(LandmarkMap, UpdateReturnsTheLogDensityOfTheObservationAndZeroForANewLandmark) {
  LandmarkMap map;
  EXPECT_EQ(map.update(0, {}, {.range_m = 4.0, .bearing_rad = 0.0}, kNoise), 0.0);
  const RangeBearing again{.range_m = 4.6, .bearing_rad = -0.1};
  const double expected = landmark_innovation({}, map.at(0), again, kNoise).log_density();
  EXPECT_EQ(map.update(0, {}, again, kNoise), expected);
}

// The textbook's matrices, H P H^T + R and (I - K H) P, for landmarks and poses all about.
TEST(LandmarkMap, ClosedFormIsTheMatrixForm) {
  const RandomStream stream(1, "test/closed_form");
  for (std::uint64_t i = 0; i < 200; ++i) {
    const auto place = stream.normals(i, 0), shape = stream.normals(i, 1), error = stream.normals(i, 2);
    const Pose2 pose{error[2], error[3], 3.0 * std::tanh(place[2])};
    const Eigen::Matrix2d root =
        (Eigen::Matrix2d() << 0.4 * shape[0], 0.3 * shape[1], 0.2 * shape[2], 0.5 * shape[3]).finished();
    LandmarkMap map;
    map.landmarks().push_back(
        {.mean_m = {5.0 * place[0], 5.0 * place[1]}, .covariance = root * root.transpose(), .is_observed = true});
    const Landmark before = map.at(0);
    const PredictedObservation predicted = predict_observation(pose, before.mean_m);
    const RangeBearing observations{.range_m = predicted.observation.x() + 0.3 * error[0],
                                    .bearing_rad = wrap_angle(predicted.observation.y() + 0.1 * error[1])};

    const Eigen::Matrix2d& H = predicted.H_landmark;
    const Eigen::Matrix2d S = H * before.covariance * H.transpose() + kNoise.covariance(),
                          K = before.covariance * H.transpose() * S.inverse();
    const Eigen::Vector2d innovation = innovation_of(observations, predicted);
    const LandmarkInnovation fit = landmark_innovation(pose, before, observations, kNoise);
    EXPECT_LT((fit.S_inverse() * S - Eigen::Matrix2d::Identity()).norm(), 1e-9) << i;
    EXPECT_LT((fit.H_pose() - predicted.H_pose).norm(), kExactTol) << i;
    EXPECT_NEAR(fit.squared_distance, innovation.dot(S.inverse() * innovation), 1e-9) << i;

    map.update(0, pose, observations, kNoise);
    EXPECT_LT((map.at(0).mean_m - (before.mean_m + K * innovation)).norm(), 1e-9) << i;
    EXPECT_LT((map.at(0).covariance - (before.covariance - K * H * before.covariance)).norm(), 1e-9) << i;
    EXPECT_EQ(map.at(0).covariance(0, 1), map.at(0).covariance(1, 0)) << i;
  }
}

// Sharp enough that the product of 1,000 determinants, 1e-6 each or less, is under what a double can be.
TEST(ObservationLikelihood, OfAThousandObservationsIsTheSumOfTheInnovations) {
  const RandomStream stream(1, "test/sights");
  const RangeBearingNoise noise{.range_std_m = 0.02, .bearing_std_rad = 0.01};
  const Pose2 pose{0.5, -0.3, 3.0};
  ObservationLikelihood likelihood(pose, noise);
  double sum = 0.0;
  for (std::uint64_t i = 0; i < 1000; ++i) {
    const auto place = stream.normals(i, 0), shape = stream.normals(i, 1), error = stream.normals(i, 2);
    const Eigen::Matrix2d root =
        (Eigen::Matrix2d() << 0.03 * shape[0], 0.02 * shape[1], 0.02 * shape[2], 0.03 * shape[3]).finished();
    const Landmark landmark{
        .mean_m = {5.0 * place[0], 5.0 * place[1]}, .covariance = root * root.transpose(), .is_observed = true};
    const Eigen::Vector2d observation =
        predict_observation(pose, landmark.mean_m).observation;  // in all directions, across the wrap too
    const RangeBearing observations{.range_m = observation.x() + 0.05 * error[0],
                                    .bearing_rad = wrap_angle(observation.y() + 0.02 * error[1])};
    likelihood.add(landmark, observations);
    sum += landmark_innovation(pose, landmark, observations, noise).log_density();
  }
  EXPECT_NEAR(likelihood.log_density(), sum, 1e-10 * std::abs(sum));
}

}  // namespace
}  // namespace patrol::studies::landmark_map_test
