#include "sim/locomotion/swing_trajectory.h"

#include <gtest/gtest.h>

namespace patrol::sim::swing_trajectory_test {
namespace {

const Eigen::Vector3d kLiftOff(-0.1, 0.05, -0.30), kTouchDown(0.15, 0.02, -0.25);
constexpr double kDuration_s = 0.18;

FootMotion at(double fraction) { return swing_foot(kLiftOff, kTouchDown, 0.09, fraction, kDuration_s); }

TEST(SwingTrajectory, StartsAndEndsAtItsEndsAtRest) {
  EXPECT_NEAR((at(0.0).position - kLiftOff).norm(), 0.0, 1e-12);
  EXPECT_NEAR((at(1.0).position - kTouchDown).norm(), 0.0, 1e-12);
  EXPECT_NEAR(at(0.0).velocity.norm(), 0.0, 1e-12);
  EXPECT_NEAR(at(1.0).velocity.norm(), 0.0, 1e-12);
}

TEST(SwingTrajectory, PassesTheMiddleNineCentimetresOverTheHigherEnd) {
  double highest = -1.0;
  for (double s = 0.0; s <= 1.0; s += 0.01) highest = std::max(highest, at(s).position.z());
  EXPECT_NEAR(highest, -0.25 + 0.09, 1e-12);
  EXPECT_NEAR(at(0.5).position.z(), highest, 1e-12);
  EXPECT_NEAR((at(0.5).position - (kLiftOff + kTouchDown) / 2.0).head<2>().norm(), 0.0, 1e-12);
}

TEST(SwingTrajectory, TheVelocityIsTheDerivativeOfThePosition) {
  constexpr double kStep = 1e-6;
  for (double s = 0.005; s < 1.0; s += 0.01) {
    const Eigen::Vector3d difference = (at(s + kStep).position - at(s - kStep).position) / (2.0 * kStep * kDuration_s);
    EXPECT_NEAR((at(s).velocity - difference).norm(), 0.0, 1e-5) << s;
  }
}

TEST(SwingTrajectory, StaysAtTouchDownWhenAskedBeyondItsEnd) { EXPECT_EQ(at(1.4).position, at(1.0).position); }

TEST(SwingTrajectory, IsAtFullHeightOverTheMiddleFifthSoThatAKerbIsPassedHigh) {
  for (double s = 0.4; s <= 0.6; s += 0.02) EXPECT_NEAR(at(s).position.z(), -0.16, 1e-12) << s;
}

}  // namespace
}  // namespace patrol::sim::swing_trajectory_test
