#include "plan/perception/low_obstacles.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace patrol::plan::low_obstacles_test {
namespace {

constexpr Cell kHere{3, -4};
const std::vector<Cell> kNothing;

Time at(double time_s) { return from_seconds(time_s); }

TEST(LowObstacles, TwoImagesMakeAnObstacleOneDoesNot) {
  LowObstacles low({.confirmations = 2});
  low.add_image({kHere}, kNothing, {false}, at(0.0));
  EXPECT_FALSE(low.is_obstacle(kHere));
  low.add_image({kHere}, kNothing, {false}, at(0.2));
  EXPECT_TRUE(low.is_obstacle(kHere));
  EXPECT_THAT(low.take_changed(), ::testing::ElementsAre(kHere));
  EXPECT_TRUE(low.take_changed().empty());
  EXPECT_THAT(low.obstacles(), ::testing::ElementsAre(kHere));
  EXPECT_EQ(low.num_obstacles(), 1u);
}

// The count has risen to 4 at most, so four images of ground take it away.
TEST(LowObstacles, GroundThatIsSeenTakesItAwayImageByImage) {
  LowObstacles low({.confirmations = 2});
  for (int i = 0; i < 50; ++i) low.add_image({kHere}, kNothing, {false}, at(0.2 * i));
  for (int i = 0; i < 3; ++i) low.add_image(kNothing, {kHere}, {}, at(10.0 + 0.2 * i));
  EXPECT_TRUE(low.is_obstacle(kHere));
  low.add_image(kNothing, {kHere}, {}, at(10.6));
  EXPECT_FALSE(low.is_obstacle(kHere));
  EXPECT_EQ(low.num_obstacles(), 0u);
}

TEST(LowObstacles, OutOfSightItIsRememberedForItsTime) {
  LowObstacles low({.persistence_s = 60.0, .dynamic_persistence_s = 3.0});
  const Cell person{7, 7};
  for (int i = 0; i < 2; ++i) low.add_image({kHere, person}, kNothing, {false, true}, at(1.0));
  low.clear_expired(at(3.9));
  EXPECT_TRUE(low.is_obstacle(person));
  low.clear_expired(at(4.1));
  EXPECT_FALSE(low.is_obstacle(person));
  low.clear_expired(at(60.9));
  EXPECT_TRUE(low.is_obstacle(kHere));
  low.clear_expired(at(61.1));
  EXPECT_FALSE(low.is_obstacle(kHere));
}

TEST(LowObstacles, TwoPingsMakeAnObstacleAndLongerOnesTakeItAway) {
  LowObstacles low({.confirmations = 2});
  low.add_ping({kHere}, kNothing, at(0.0));
  EXPECT_FALSE(low.is_obstacle(kHere));
  low.add_ping({kHere}, kNothing, at(0.2));
  EXPECT_TRUE(low.is_obstacle(kHere));
  low.add_ping(kNothing, {kHere}, at(0.4));
  EXPECT_FALSE(low.is_obstacle(kHere));
}

TEST(LowObstacles, SonarDoesNotUndoWhatTheCameraSaw) {
  LowObstacles low({});
  for (int i = 0; i < 2; ++i) low.add_image({kHere}, kNothing, {false}, at(0.2 * i));
  for (int i = 0; i < 20; ++i) low.add_ping(kNothing, {kHere}, at(1.0 + 0.1 * i));
  EXPECT_TRUE(low.is_obstacle(kHere));
}

TEST(LowObstacles, GroundThatTheCameraSeesUndoesWhatSonarHeardAndVetoesItForAWhile) {
  LowObstacles low({.camera_clearing_s = 2.0});
  for (int i = 0; i < 3; ++i) low.add_ping({kHere}, kNothing, at(0.1 * i));
  low.add_image(kNothing, {kHere}, {}, at(1.0));
  EXPECT_FALSE(low.is_obstacle(kHere));
  for (int i = 0; i < 5; ++i) low.add_ping({kHere}, kNothing, at(2.0));
  EXPECT_FALSE(low.is_obstacle(kHere));
  for (int i = 0; i < 2; ++i) low.add_ping({kHere}, kNothing, at(3.1));
  EXPECT_TRUE(low.is_obstacle(kHere));
}

TEST(LowObstacles, WhatOnlySonarHasHeardCanBeForgotten) {
  LowObstacles low({});
  const Cell seen{0, 0};
  for (int i = 0; i < 2; ++i) {
    low.add_ping({kHere, seen}, kNothing, at(0.1 * i));
    low.add_image({seen}, kNothing, {false}, at(0.1 * i));
  }
  low.clear_sonar_evidence([](Cell) { return true; });
  EXPECT_FALSE(low.is_obstacle(kHere));
  EXPECT_TRUE(low.is_obstacle(seen));
}

}  // namespace
}  // namespace patrol::plan::low_obstacles_test
