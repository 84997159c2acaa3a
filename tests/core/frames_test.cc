#include "core/frames.h"

#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

#include "tests/support/pose_near.h"

namespace patrol::frames_test {
namespace {

using test::Pose2Near, test::Pose3Near, test::VectorNear;
using ::testing::Not;

constexpr double kExactTol = 1e-12;  // algebra in doubles
constexpr double kPi = std::numbers::pi;

TEST(PoseNear, SeesAMillimetreAndAMilliradian) {
  const Pose2 a{1.0, 2.0, 3.0};
  EXPECT_THAT((Pose2{1.0, 2.0, 3.0 - 2.0 * kPi}), Pose2Near(a, 0.0, kExactTol));
  EXPECT_THAT((Pose2{1.001, 2.0, 3.0}), Not(Pose2Near(a, 0.0009, 1.0)));
  EXPECT_THAT((Pose2{1.0, 2.0, 3.001}), Not(Pose2Near(a, 1.0, 0.0009)));
  const Pose3 b = to_pose3(a);
  EXPECT_THAT(to_pose3({1.001, 2.0, 3.0}), Not(Pose3Near(b, 0.0009, 1.0)));
  EXPECT_THAT(to_pose3({1.0, 2.0, 3.001}), Not(Pose3Near(b, 1.0, 0.0009)));
  EXPECT_THAT((Pose3{b.position, Eigen::Quaterniond(-b.rotation.coeffs())}), Pose3Near(b, 0.0, 1e-7));
}

TEST(WrapAngle, KeepsWhatLiesInTheHalfOpenTurnAndFoldsTheRest) {
  EXPECT_DOUBLE_EQ(wrap_angle(kPi), kPi);
  EXPECT_DOUBLE_EQ(wrap_angle(-kPi), kPi);
  EXPECT_NEAR(wrap_angle(kPi + 0.1), -kPi + 0.1, kExactTol);
  EXPECT_NEAR(wrap_angle(-kPi - 0.1), kPi - 0.1, kExactTol);
  EXPECT_NEAR(wrap_angle(7.0 * kPi), kPi, kExactTol);
  EXPECT_DOUBLE_EQ(wrap_angle(0.0), 0.0);
}

// To the bit: who adds two wrapped angles must not see which way was taken.
TEST(WrapAngle, IsTheRemainderOfAWholeTurnFromMinusTwelveToTwelve) {
  for (int i = -12'000; i <= 12'000; ++i) {
    const double angle = 0.001 * i;
    EXPECT_EQ(wrap_angle(angle), std::remainder(angle, 2.0 * kPi)) << angle;
  }
  for (const double angle : {std::nextafter(kPi, 4.0), std::nextafter(-kPi, -4.0), std::nextafter(kPi, 0.0)}) {
    EXPECT_EQ(wrap_angle(angle), std::remainder(angle, 2.0 * kPi)) << angle;
  }
}

TEST(Pose2, AQuarterTurnTakesForwardToLeft) {
  const Pose2 T_map_body{10.0, 20.0, kPi / 2.0};
  EXPECT_THAT((T_map_body * Eigen::Vector2d(1.0, 0.0)), VectorNear(Eigen::Vector2d(10.0, 21.0), kExactTol));
}

TEST(Pose2, FourTurnsAndStepsComeHome) {
  const Pose2 side{3.0, 0.0, kPi / 2.0};
  EXPECT_THAT(side * side * side * side, Pose2Near(Pose2{}, kExactTol, kExactTol));
}

TEST(Pose2, InverseUndoesOnBothSides) {
  const Pose2 T{1.5, -2.5, 2.9};
  EXPECT_THAT(T * T.inverse(), Pose2Near(Pose2{}, kExactTol, kExactTol));
  EXPECT_THAT(T.inverse() * T, Pose2Near(Pose2{}, kExactTol, kExactTol));
}

TEST(Pose2, CompositionActsAsOneAfterTheOtherAndWraps) {
  const Pose2 T_a_b{1.0, 2.0, 3.0}, T_b_c{-4.0, 0.5, 2.0};
  const Eigen::Vector2d p_c(0.3, -0.7);
  EXPECT_THAT(((T_a_b * T_b_c) * p_c), VectorNear(Eigen::Vector2d(T_a_b * (T_b_c * p_c)), kExactTol));
  EXPECT_NEAR((T_a_b * T_b_c).yaw, 5.0 - 2.0 * kPi, kExactTol);
}

TEST(Pose3, AgreesWithPose2InThePlane) {
  const Pose2 T_a_b{1.0, 2.0, 3.0}, T_b_c{-4.0, 0.5, 2.0};
  EXPECT_THAT(to_pose2(to_pose3(T_a_b, 0.3) * to_pose3(T_b_c)), Pose2Near(T_a_b * T_b_c, kExactTol, kExactTol));
  EXPECT_THAT(to_pose2(to_pose3(T_a_b).inverse()), Pose2Near(T_a_b.inverse(), kExactTol, kExactTol));
  EXPECT_DOUBLE_EQ((to_pose3(T_a_b, 0.3) * to_pose3(T_b_c)).position.z(), 0.3);
}

TEST(Pose3, InverseUndoesATiltedPose) {
  const Pose3 T{{1.0, 2.0, 3.0}, quaternion_from_rpy(0.4, -1.1, 2.5)};
  EXPECT_THAT(T * T.inverse(), Pose3Near(Pose3{}, kExactTol, 1e-7));
  EXPECT_THAT((T.inverse() * (T * Eigen::Vector3d(5.0, 6.0, 7.0))),
              VectorNear(Eigen::Vector3d(5.0, 6.0, 7.0), kExactTol));
}

TEST(QuaternionFromRpy, TurnsAboutFixedXThenYThenZ) {
  // Roll of 90 degrees takes y to z; then a yaw of 90 degrees leaves z.
  const Eigen::Quaterniond q = quaternion_from_rpy(kPi / 2.0, 0.0, kPi / 2.0);
  EXPECT_THAT((q * Eigen::Vector3d::UnitY()), VectorNear(Eigen::Vector3d(0.0, 0.0, 1.0), kExactTol));
  EXPECT_THAT((q * Eigen::Vector3d::UnitX()), VectorNear(Eigen::Vector3d(0.0, 1.0, 0.0), kExactTol));
  // Positive pitch puts the nose down.
  EXPECT_LT((quaternion_from_rpy(0.0, 0.2, 0.0) * Eigen::Vector3d::UnitX()).z(), 0.0);
}

TEST(YawOf, ReadsTheHeadingUnderAnyTilt) {
  for (const double yaw : {-3.0, -0.5, 0.0, 1.0, 3.1}) {
    EXPECT_NEAR(to_yaw(quaternion_from_rpy(0.3, -0.2, yaw)), yaw, kExactTol);
    EXPECT_NEAR(to_yaw(quaternion_from_yaw(yaw)), yaw, kExactTol);
  }
}

TEST(Interpolate, HalfwayHalvesWayAndTurn) {
  const Pose3 a, b{{2.0, 4.0, -6.0}, quaternion_from_yaw(1.0)};
  EXPECT_THAT(interpolate(a, b, 0.0), Pose3Near(a, 0.0, 1e-7));
  EXPECT_THAT(interpolate(a, b, 1.0), Pose3Near(b, kExactTol, 1e-7));
  EXPECT_THAT(interpolate(a, b, 0.5), Pose3Near((Pose3{{1.0, 2.0, -3.0}, quaternion_from_yaw(0.5)}), kExactTol, 1e-7));
}

TEST(Interpolate, TurnsTheShortWayAcrossTheHalfTurn) {
  const Pose3 a{{}, quaternion_from_yaw(kPi - 0.1)}, b{{}, quaternion_from_yaw(-kPi + 0.1)};
  EXPECT_NEAR(std::abs(to_yaw(interpolate(a, b, 0.5).rotation)), kPi, 1e-9);
}

}  // namespace
}  // namespace patrol::frames_test
