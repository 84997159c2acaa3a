#include "studies/landmarks/association.h"

#include <cmath>

#include <gtest/gtest.h>

namespace patrol::studies::association_test {
namespace {

const RangeBearingNoise kNoise{.range_std_m = 0.5, .bearing_std_rad = 0.1};
const AssociationSettings kUnknown{.is_known = false};

/// Known for certain, so that a sight's squared distance is (dr / 0.5)^2 + (db / 0.1)^2: 10 m ahead, 10 m to the left,
/// and 10 m behind.
LandmarkMap three_landmarks() {
  LandmarkMap map;
  for (const Eigen::Vector2d& p :
       {Eigen::Vector2d(10.0, 0.0), Eigen::Vector2d(0.0, 10.0), Eigen::Vector2d(-10.0, 0.0)}) {
    map.landmarks().push_back({.mean_m = p, .covariance = Eigen::Matrix2d::Zero(), .is_observed = true});
  }
  return map;
}

RangeBearing observation(double range_m, double bearing_rad, int landmark = 0) {
  return {.landmark = landmark, .range_m = range_m, .bearing_rad = bearing_rad};
}

std::vector<int> match(const std::vector<RangeBearing>& observations, const AssociationSettings& settings = kUnknown) {
  return associate(three_landmarks(), {}, observations, kNoise, settings);
}

TEST(Associate, KnownAssociationKeepsTheNumbers) {
  EXPECT_EQ(match({observation(1.0, 2.0, 7), observation(99.0, 0.0, 0), observation(10.0, 0.0, 7)}, {.is_known = true}),
            (std::vector<int>{7, 0, 7}));
}

// 1.0 m off: (1 / 0.5)^2 = 4.
TEST(Associate, UnknownTakesTheNearestWithinTheGate) {
  EXPECT_EQ(match({observation(10.0, 1.6), observation(11.0, 0.1), observation(9.5, -3.1)}),
            (std::vector<int>{1, 0, 2}));
}

// 1.5 m off is 9, within 99 % of chi^2 (9.21); 1.6 m is 10.24, 2.4 m is 23.04: too far for the landmark, too near for a
// new one; 2.6 m is 27.04.
TEST(Associate, BetweenNineAndTwentyFiveAnObservationIsDiscarded) {
  EXPECT_EQ(match({observation(11.5, 0.0)}), std::vector<int>{0});
  EXPECT_EQ(match({observation(11.6, 0.0)}), std::vector<int>{kUnmatched});
  EXPECT_EQ(match({observation(12.4, 0.0)}), std::vector<int>{kUnmatched});
  EXPECT_EQ(match({observation(12.6, 0.0)}), std::vector<int>{3});
}

TEST(Associate, TwoNewOnesOfOneLookAreTwoLandmarks) {
  EXPECT_EQ(match({observation(20.0, 0.0), observation(10.0, 0.0), observation(20.0, 1.0)}),
            (std::vector<int>{3, 0, 4}));
}

// The second sight of the same place is no new landmark: it is near to one.
TEST(Associate, TakesNoLandmarkTwice) {
  EXPECT_EQ(match({observation(10.2, 0.0), observation(10.0, 0.0)}), (std::vector<int>{0, kUnmatched}));
}

// Both within the gate: the distance to the vague one is the smaller, (1 / 2.06)^2 against (0.7 / 0.5)^2, but there the
// sight is less probable: -0.5 (0.24 + 2 ln 2.06) = -0.84 against -0.5 (1.96 + 2 ln 0.5) = -0.29.
TEST(Associate, PrefersTheMoreProbableToTheNearer) {
  LandmarkMap map;
  map.landmarks().push_back({.mean_m = {10.0, 0.0}, .covariance = Eigen::Matrix2d::Zero(), .is_observed = true});
  map.landmarks().push_back(
      {.mean_m = {11.7, 0.0}, .covariance = Eigen::Vector2d(4.0, 0.0).asDiagonal(), .is_observed = true});
  EXPECT_EQ(associate(map, {}, {observation(10.7, 0.0)}, kNoise, kUnknown), std::vector<int>{0});
}

TEST(Associate, OnAnEmptyMapAllObservationsAreNewLandmarks) {
  EXPECT_EQ(associate({}, {}, {observation(10.0, 0.0), observation(10.0, 0.0)}, kNoise, kUnknown),
            (std::vector<int>{0, 1}));
  EXPECT_TRUE(match({}).empty());
}

// A look from elsewhere: the first landmark is straight to the right of (10, 5) facing +x, 5 m away.
TEST(Associate, PredictsFromThePoseThatItIsGiven) {
  EXPECT_EQ(associate(three_landmarks(), {10.0, 5.0, 0.0}, {observation(5.0, -1.5708)}, kNoise, kUnknown),
            std::vector<int>{0});
}

}  // namespace
}  // namespace patrol::studies::association_test
