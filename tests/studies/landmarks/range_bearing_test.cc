#include "studies/landmarks/range_bearing.h"

#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

#include "core/geometry/angles.h"
#include "tests/support/pose_near.h"

namespace patrol::studies::range_bearing_test {
namespace {

constexpr double kExactTol = 1e-12;
constexpr double kStep = 1e-6;  // of the central differences: their error is its square, and rounding 1e-16 / 1e-6
constexpr double kDifferenceTol = 1e-9;

// A 3-4-5 triangle, seen by a body that faces +y.
TEST(PredictObservation, ThreeAheadAndFourToTheRightIsFiveMetersAway) {
  const Eigen::Vector2d observation = predict_observation({1.0, 2.0, 0.5 * std::numbers::pi}, {5.0, 5.0}).observation;
  EXPECT_NEAR(observation.x(), 5.0, kExactTol);
  EXPECT_NEAR(observation.y(), -std::atan2(4.0, 3.0), kExactTol);
}

TEST(PredictObservation, DerivativesAreTheCentralDifferences) {
  const Pose2 pose{0.4, -1.0, 2.5};
  for (const Eigen::Vector2d& p : {Eigen::Vector2d(3.0, 2.0), Eigen::Vector2d(-2.0, -0.5), Eigen::Vector2d(0.4, 1.0)}) {
    const PredictedObservation predicted = predict_observation(pose, p);
    const auto slope = [](const Eigen::Vector2d& ahead, const Eigen::Vector2d& behind) -> Eigen::Vector2d {
      return Eigen::Vector2d(ahead.x() - behind.x(), wrap_angle(ahead.y() - behind.y())) / (2.0 * kStep);
    };
    for (int i = 0; i < 2; ++i) {
      const Eigen::Vector2d d = kStep * Eigen::Vector2d::Unit(i);
      EXPECT_LT((predicted.H_landmark.col(i) -
                 slope(predict_observation(pose, p + d).observation, predict_observation(pose, p - d).observation))
                    .norm(),
                kDifferenceTol)
          << i;
    }
    for (int i = 0; i < 3; ++i) {
      const Eigen::Vector3d d = kStep * Eigen::Vector3d::Unit(i);
      const Pose2 ahead{pose.x + d.x(), pose.y + d.y(), pose.yaw + d.z()},
          behind{pose.x - d.x(), pose.y - d.y(), pose.yaw - d.z()};
      EXPECT_LT((predicted.H_pose.col(i) -
                 slope(predict_observation(ahead, p).observation, predict_observation(behind, p).observation))
                    .norm(),
                kDifferenceTol)
          << i;
    }
  }
}

// Straight behind: predicted at 179 degrees, seen at -179.
TEST(InnovationOf, OfTwoDegreesAcrossTheWrapIsTwoDegrees) {
  const PredictedObservation predicted =
      predict_observation({}, {10.0 * std::cos(179.0 * kDegree), 10.0 * std::sin(179.0 * kDegree)});
  const Eigen::Vector2d innovation =
      innovation_of({.landmark = 0, .range_m = 10.5, .bearing_rad = -179.0 * kDegree}, predicted);
  EXPECT_NEAR(innovation.x(), 0.5, kExactTol);
  EXPECT_NEAR(innovation.y(), 2.0 * kDegree, kExactTol);
}

TEST(InvertObservation, IsTheInverseOfThePrediction) {
  const Pose2 pose{1.0, -2.0, 2.9};
  const Eigen::Vector2d p(-3.0, 4.0), observation = predict_observation(pose, p).observation;
  EXPECT_THAT(invert_observation(pose, {.landmark = 0, .range_m = observation.x(), .bearing_rad = observation.y()}),
              test::VectorNear(p, kExactTol));
}

// Range 0 has no bearing: finite all the same.
TEST(PredictObservation, OfALandmarkAtTheBodyIsFinite) {
  const PredictedObservation predicted = predict_observation({1.0, 2.0, 0.3}, {1.0, 2.0});
  EXPECT_TRUE(predicted.observation.allFinite() && predicted.H_landmark.allFinite() && predicted.H_pose.allFinite());
  EXPECT_NEAR(predicted.observation.x(), 0.0, 1e-5);
}

TEST(RangeBearingNoise, CovarianceIsTheSquaresOfHalfAMeterAndATenthOfARadian) {
  const Eigen::Matrix2d covariance = RangeBearingNoise{.range_std_m = 0.5, .bearing_std_rad = 0.1}.covariance();
  EXPECT_LT((covariance - Eigen::Matrix2d(Eigen::Vector2d(0.25, 0.01).asDiagonal())).norm(), kExactTol);
}

}  // namespace
}  // namespace patrol::studies::range_bearing_test
