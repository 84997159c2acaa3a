#include "core/leg_kinematics.h"

#include <numbers>

#include <gtest/gtest.h>

#include "core/random.h"
#include "tests/support/pose_near.h"

namespace patrol::leg_kinematics_test {
namespace {

using test::VectorNear;

constexpr double kExactTol = 1e-12;
constexpr double kPi = std::numbers::pi;

// Lengths that give whole numbers; left legs have their thigh at +y.
const LegGeometry kLeft{.name = "FL",
                        .hip_in_body = {2.0, 1.0, 0.0},
                        .abduction_offset_m = 1.0,
                        .thigh_m = 3.0,
                        .shank_m = 4.0,
                        .foot_radius_m = 0.1};
const LegGeometry kRight{.name = "FR",
                         .hip_in_body = {2.0, -1.0, 0.0},
                         .abduction_offset_m = -1.0,
                         .thigh_m = 3.0,
                         .shank_m = 4.0,
                         .foot_radius_m = 0.1};

TEST(FootPosition, StretchedLegHangsSevenBelowTheHip) {
  EXPECT_THAT(foot_position(kLeft, {0.0, 0.0, 0.0}), VectorNear(Eigen::Vector3d(2.0, 2.0, -7.0), kExactTol));
}

TEST(FootPosition, KneeBentARightAngleBackMakesThreeByFour) {
  // Thigh straight down, shank turned by -90 degrees about y: from -z to +x.
  EXPECT_THAT(foot_position(kLeft, {0.0, 0.0, -kPi / 2.0}), VectorNear(Eigen::Vector3d(6.0, 2.0, -3.0), kExactTol));
}

TEST(FootPosition, PositiveHipSwingsTheLegBack) {
  EXPECT_THAT(foot_position(kLeft, {0.0, kPi / 2.0, 0.0}), VectorNear(Eigen::Vector3d(-5.0, 2.0, 0.0), kExactTol));
}

TEST(FootPosition, AbductionOfARightAngleTurnsTheLegAboutX) {
  // About +x, y goes to z and -z to y: the offset 1 up, the leg 7 outwards.
  EXPECT_THAT(foot_position(kLeft, {kPi / 2.0, 0.0, 0.0}), VectorNear(Eigen::Vector3d(2.0, 8.0, 1.0), kExactTol));
}

TEST(FootPosition, LeftAndRightAreMirrorImages) {
  const Eigen::Vector3d left = foot_position(kLeft, {0.3, 0.8, -1.6}), right = foot_position(kRight, {-0.3, 0.8, -1.6});
  EXPECT_THAT(right, VectorNear(Eigen::Vector3d(left.x(), -left.y(), left.z()), kExactTol));
}

/// A posture of a real leg: abduction within 0.8, hip within -0.8 ... 2.5, knee -2.7 ... -0.3 rad.
Eigen::Vector3d random_posture(const RandomStream& stream, std::uint64_t i) {
  return {1.6 * stream.uniform(i, 0) - 0.8, 3.3 * stream.uniform(i, 1) - 0.8, -2.4 * stream.uniform(i, 2) - 0.3};
}

TEST(FootJacobian, IsTheNumericalDerivativeToOneMicrometrePerRadian) {
  constexpr double kStep = 1e-5;  // central difference errs by its square
  const RandomStream stream(1, "test/leg");
  for (const LegGeometry& leg : {kLeft, kRight}) {
    for (std::uint64_t i = 0; i < 50; ++i) {
      const Eigen::Vector3d q = random_posture(stream, i);
      const Eigen::Matrix3d J = foot_jacobian(leg, q);
      for (int joint = 0; joint < 3; ++joint) {
        const Eigen::Vector3d dq = kStep * Eigen::Vector3d::Unit(joint);
        const Eigen::Vector3d numeric = (foot_position(leg, q + dq) - foot_position(leg, q - dq)) / (2.0 * kStep);
        EXPECT_THAT(Eigen::Vector3d(J.col(joint)), VectorNear(numeric, 1e-6)) << "joint " << joint;
      }
    }
  }
}

TEST(JointAngles, PutTheFootWhereItWasAskedFor) {
  const RandomStream stream(2, "test/leg");
  for (const LegGeometry& leg : {kLeft, kRight}) {
    for (std::uint64_t i = 0; i < 200; ++i) {
      const Eigen::Vector3d foot = foot_position(leg, random_posture(stream, i));
      const auto q = joint_angles(leg, foot);
      ASSERT_TRUE(q);
      EXPECT_LT((*q)[2], 0.0) << "the knee bends backwards";
      EXPECT_THAT(foot_position(leg, *q), VectorNear(foot, 1e-9));
    }
  }
}

TEST(JointAngles, RecoverAStandingPosture) {
  const Eigen::Vector3d standing(0.1, 0.8, -1.6);
  for (const LegGeometry& leg : {kLeft, kRight}) {
    const auto q = joint_angles(leg, foot_position(leg, standing));
    ASSERT_TRUE(q);
    EXPECT_THAT(*q, VectorNear(standing, 1e-9));
  }
}

TEST(JointAngles, OutOfReachIsNoAnswer) {
  const auto below_hip = [](double z) { return Eigen::Vector3d(2.0, 2.0, z); };
  EXPECT_TRUE(joint_angles(kLeft, below_hip(-6.999)));
  EXPECT_FALSE(joint_angles(kLeft, below_hip(-7.001)));               // longer than thigh and shank
  EXPECT_FALSE(joint_angles(kLeft, below_hip(-0.999)));               // nearer than their difference
  EXPECT_FALSE(joint_angles(kLeft, Eigen::Vector3d(6.0, 1.5, 0.0)));  // within the abduction offset
}

}  // namespace
}  // namespace patrol::leg_kinematics_test
