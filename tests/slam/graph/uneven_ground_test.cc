#include "slam/graph/uneven_ground.h"

#include <cmath>

#include <gtest/gtest.h>

namespace patrol::slam::uneven_ground_test {
namespace {

/// Adds scans every 0.1 m.
template <typename Tilt>
void drive(UnevenGround& ground, int num_scans, Tilt&& tilt_rad) {
  for (int k = 0; k < num_scans; ++k) ground.add({.stamp = {}, .tilt_rad = tilt_rad(k), .beams = {}}, 0.1);
}

TEST(UnevenGround, IsNotNearWithTheSwayOfAWalkingRobot) {
  UnevenGround ground;
  drive(ground, 300, [](int k) { return 0.1 * std::abs(std::sin(0.8 * k)); });
  EXPECT_FALSE(ground.is_near());
}

TEST(UnevenGround, IsNearAfterTwoMetersOfASlopeAndForTenMetersBehindIt) {
  UnevenGround ground;
  const auto slope = [](int) { return 0.05; };
  const auto level = [](int) { return 0.01; };
  drive(ground, 19, slope);
  EXPECT_FALSE(ground.is_near());
  drive(ground, 2, slope);
  EXPECT_TRUE(ground.is_near());
  drive(ground, 99, level);
  EXPECT_TRUE(ground.is_near());
  drive(ground, 2, level);
  EXPECT_FALSE(ground.is_near());
}

TEST(UnevenGround, ARobotThatStandsOnASlopeIsNotYetNearIt) {
  UnevenGround ground;
  for (int k = 0; k < 300; ++k) ground.add({.stamp = {}, .tilt_rad = 0.05, .beams = {}}, 0.0);
  EXPECT_FALSE(ground.is_near());
}

}  // namespace
}  // namespace patrol::slam::uneven_ground_test
