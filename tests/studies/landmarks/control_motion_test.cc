#include "studies/landmarks/control_motion.h"

#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

#include "tests/support/pose_near.h"

namespace patrol::studies::control_motion_test {
namespace {

using test::Pose2Near;

constexpr double kExactTol = 1e-12;
constexpr double kStep = 1e-6;  // of the central differences: their error is its square, and rounding 1e-16 / 1e-6
constexpr double kDifferenceTol = 1e-9;

const ControlMotion kYawRateMotion{.steering = Steering::kYawRate, .step_s = 0.1};
const ControlMotion kCar{.steering = Steering::kAckermann, .wheelbase_m = 2.0, .step_s = 0.1};
const ControlMotion kCarInFiveParts{.steering = Steering::kAckermann, .wheelbase_m = 2.0, .step_s = 0.5, .substeps = 5};

Eigen::Vector3d difference(const Pose2& a, const Pose2& b) { return {a.x - b.x, a.y - b.y, wrap_angle(a.yaw - b.yaw)}; }

void expect_jacobians_are_the_differences(const ControlMotion& motion, const Pose2& pose, const Control& control) {
  const ControlMotionJacobian jacobian = jacobian_of(motion, pose, control);
  for (int i = 0; i < 3; ++i) {
    const Eigen::Vector3d d = kStep * Eigen::Vector3d::Unit(i);
    const Pose2 ahead{pose.x + d.x(), pose.y + d.y(), pose.yaw + d.z()},
        behind{pose.x - d.x(), pose.y - d.y(), pose.yaw - d.z()};
    const Eigen::Vector3d slope = difference(motion.move(ahead, control), motion.move(behind, control)) / (2.0 * kStep);
    EXPECT_LT((jacobian.pose.col(i) - slope).norm(), kDifferenceTol) << "by the pose's " << i;
  }
  for (int i = 0; i < 2; ++i) {
    const Eigen::Vector2d d = kStep * Eigen::Vector2d::Unit(i);
    const Eigen::Vector3d slope =
        difference(motion.move(pose, control + d), motion.move(pose, control - d)) / (2.0 * kStep);
    EXPECT_LT((jacobian.control.col(i) - slope).norm(), kDifferenceTol) << "by the control's " << i;
  }
}

TEST(ControlMotionJacobian, IsTheCentralDifferenceForBothSteeringsAndInParts) {
  for (const ControlMotion& motion :
       {kYawRateMotion, kCar, kCarInFiveParts, ControlMotion{.step_s = 0.3, .substeps = 3}}) {
    for (const Control& control : {Control(1.2, 0.3), Control(-0.7, -0.4), Control(0.0, 0.2), Control(2.0, 0.0)}) {
      expect_jacobians_are_the_differences(motion, {0.5, -2.0, 0.8}, control);
      expect_jacobians_are_the_differences(motion, {0.5, -2.0, std::numbers::pi}, control);  // across the wrap
    }
  }
}

TEST(ControlMotion, OneMeterStraightAheadIsOneMeter) {
  for (const ControlMotion& motion : {kYawRateMotion, kCar}) {
    EXPECT_THAT(motion.move({1.0, 2.0, 0.5 * std::numbers::pi}, {10.0, 0.0}),
                Pose2Near((Pose2{1.0, 3.0, 0.5 * std::numbers::pi}), kExactTol, kExactTol));
  }
}

// 40 steps of 9 degrees.
TEST(ControlMotion, FortyStepsOfNineDegreesCloseACircle) {
  Pose2 pose;
  for (int k = 0; k < 40; ++k) pose = kYawRateMotion.move(pose, {1.0, std::numbers::pi / 2.0});
  EXPECT_THAT(pose, Pose2Near(Pose2{}, 40.0 * kExactTol, 40.0 * kExactTol));
}

// After half of them it is a diameter to the left: a polygon of 40 chords of 0.1 m, 0.1 / sin(4.5 deg) = 1.2745 m.
TEST(ControlMotion, HalfACircleEndsADiameterToTheLeft) {
  Pose2 pose;
  for (int k = 0; k < 20; ++k) pose = kYawRateMotion.move(pose, {1.0, std::numbers::pi / 2.0});
  EXPECT_THAT(pose, Pose2Near((Pose2{0.0, 0.1 / std::sin(std::numbers::pi / 40.0), std::numbers::pi}), 20.0 * kExactTol,
                              20.0 * kExactTol));
}

// d = 0.1 m at G = 30 degrees and L = 2 m: turn 0.1 x 0.5 / 2 = 0.025 rad, step along the wheel.
TEST(ControlMotion, ACarTurnsByDSinGOverL) {
  const Pose2 pose = kCar.move({}, {1.0, std::numbers::pi / 6.0});
  EXPECT_NEAR(pose.yaw, 0.025, kExactTol);
  EXPECT_NEAR(pose.x, 0.1 * std::sqrt(0.75), kExactTol);
  EXPECT_NEAR(pose.y, 0.05, kExactTol);
}

// 40 steps of 1 m, each turning by 2 pi / 40 = sin G / L.
TEST(ControlMotion, FortyStepsOfACarCloseACircle) {
  const ControlMotion fast{.steering = Steering::kAckermann, .wheelbase_m = 2.0, .step_s = 1.0};
  Pose2 pose;
  for (int k = 0; k < 40; ++k) pose = fast.move(pose, {1.0, std::asin(2.0 * 2.0 * std::numbers::pi / 40.0)});
  EXPECT_THAT(pose, Pose2Near(Pose2{}, 40.0 * kExactTol, 40.0 * kExactTol));
}

TEST(ControlMotion, AStepInFivePartsIsFiveSteps) {
  Pose2 pose{1.0, -1.0, 3.0};
  const Pose2 at_once = kCarInFiveParts.move(pose, {2.0, 0.6});
  for (int k = 0; k < 5; ++k) pose = kCar.move(pose, {2.0, 0.6});
  EXPECT_THAT(at_once, Pose2Near(pose, 5.0 * kExactTol, 5.0 * kExactTol));
}

TEST(ControlMotion, YawIsWrappedAtPi) {
  EXPECT_NEAR(kYawRateMotion.move({0.0, 0.0, 3.1}, {0.0, 1.0}).yaw, 3.2 - 2.0 * std::numbers::pi, kExactTol);
}

TEST(ControlMotion, AtRestNothingMoves) {
  for (const ControlMotion& motion : {kYawRateMotion, kCar})
    EXPECT_THAT(motion.move({1.0, 2.0, 3.0}, {0.0, 0.0}), Pose2Near((Pose2{1.0, 2.0, 3.0}), 0.0, 0.0));
}

TEST(ControlMotion, AnIncrementOfTwoAndMinusOneIsTwoDeviationsFasterAndOneLessTurn) {
  const ControlMotion motion{.std = {0.1, 0.05}};
  EXPECT_THAT(motion.move_with_noise({1.0, 2.0, 3.0}, {1.0, 0.2}, {2.0, -1.0}),
              Pose2Near(motion.move({1.0, 2.0, 3.0}, {1.2, 0.15}), kExactTol, kExactTol));
}

}  // namespace
}  // namespace patrol::studies::control_motion_test
