#include "localize/leg_odometry.h"

#include <cmath>

#include <gtest/gtest.h>

#include "tests/support/walking_robot.h"

namespace patrol::localize::leg_odometry_test {
namespace {

constexpr double kExactTol = 1e-12;

LegSample standing_pose() {
  LegSample sample;
  for (int leg = 0; leg < kNumLegs; ++leg) sample.angle_rad.col(leg) = Eigen::Vector3d(0.0, 0.8, -1.6);
  return sample;
}

TEST(ContactDetector, CountsAFootOnceItsTouchDownIsOverAndUntilItIsReleased) {
  ContactDetector detector(
      {.contact_on_n = 15.0, .contact_off_n = 8.0, .full_weight_n = 40.0, .settling_time_s = 0.010});
  const auto at = [&](int ms, double force) {
    return detector.update(std::chrono::milliseconds(ms), {force, 0.0, 0.0, 0.0})[0];
  };
  EXPECT_EQ(at(0, 12.0), 0.0);  // below touch
  EXPECT_EQ(at(4, 20.0), 0.0);  // loaded, settling
  EXPECT_EQ(at(8, 20.0), 0.0);
  EXPECT_EQ(at(14, 20.0), 0.5);  // 20 of 40 N
  EXPECT_EQ(at(18, 60.0), 1.0);
  EXPECT_EQ(at(22, 10.0), 0.25);  // below touch but above release
  EXPECT_EQ(at(26, 7.0), 0.0);
  EXPECT_EQ(at(30, 10.0), 0.0);  // released: touch counts again
}

TEST(StanceFoot, ShankRotationMovesTheContactByRadiusTimesRate) {
  // The knee alone turns at 1 rad/s: the foot's center moves with the shank, 0.213 m below the knee; the
  // contact is 0.02 m farther from the knee along the vertical.
  const RobotDescription robot = test::make_quadruped();
  LegSample sample;
  sample.angle_rad.col(0) = Eigen::Vector3d(0.0, 0.9, -0.9);  // shank vertical
  sample.speed_radps.col(0) = Eigen::Vector3d(0.0, 0.0, 1.0);
  const StanceFoot foot = stance_foot(robot.legs[0], 0, sample, Eigen::Vector3d::UnitZ());
  EXPECT_NEAR(foot.v_contact.x(), -(0.213 + 0.02), kExactTol);
  EXPECT_NEAR(foot.v_contact.z(), 0.0, kExactTol);
}

TEST(FuseFeet, FourFeetMovingBackwardsMeanATrunkMovingForwards) {
  StanceFeet feet;
  for (int leg = 0; leg < kNumLegs; ++leg)
    feet.push_back({.leg = leg, .p_contact = {0, 0, -0.3}, .v_contact = {-0.5, 0, 0}});
  const auto fused = fuse_feet(feet, Eigen::Vector3d::Zero(), Eigen::Vector3d(0.5, 0, 0), 0.1, 0.15);
  ASSERT_TRUE(fused);
  EXPECT_NEAR((fused->v_body - Eigen::Vector3d(0.5, 0, 0)).norm(), 0.0, kExactTol);
  EXPECT_NEAR(fused->variance, 0.1 * 0.1 / 4.0, kExactTol);
  EXPECT_EQ(fused->num_slipping, 0);
}

TEST(FuseFeet, ARotatingTrunkOverFeetAtRestIsNotTranslating) {
  // omega = 1 rad/s about z; seen from the trunk a foot at (x, y) moves with -omega x p.
  const Eigen::Vector3d omega(0, 0, 1.0);
  StanceFeet feet;
  for (const Eigen::Vector3d& p : {Eigen::Vector3d(0.2, 0.1, -0.3), Eigen::Vector3d(-0.2, -0.1, -0.3)}) {
    feet.push_back({.p_contact = p, .v_contact = -omega.cross(p)});
  }
  EXPECT_NEAR(fuse_feet(feet, omega, Eigen::Vector3d::Zero(), 0.1, 0.15)->v_body.norm(), 0.0, kExactTol);
  EXPECT_NEAR(*yaw_rate_from_feet(feet), 1.0, kExactTol);
}

TEST(FuseFeet, FootSlippingFourTimesTheLimitKeepsASixteenthOfItsWeight) {
  StanceFeet feet;
  feet.push_back({.v_contact = {0.0, 0.0, 0.0}});
  feet.push_back({.v_contact = {-0.4, 0.0, 0.0}});  // says 0.4 m/s where 0 is expected
  const auto fused = fuse_feet(feet, Eigen::Vector3d::Zero(), Eigen::Vector3d::Zero(), 0.1, 0.1);
  EXPECT_NEAR(fused->v_body.x(), 0.4 / 16.0 / (1.0 + 1.0 / 16.0), kExactTol);
  EXPECT_EQ(fused->num_slipping, 1);
}

TEST(FuseFeet, NoFootNoAnswer) {
  const StanceFeet none;
  EXPECT_FALSE(fuse_feet(none, Eigen::Vector3d::Zero(), Eigen::Vector3d::Zero(), 0.1, 0.1));
  EXPECT_FALSE(height_from_feet(none, Eigen::Vector3d::UnitZ()));
  EXPECT_FALSE(yaw_rate_from_feet(none));
}

TEST(HeightFromFeet, IsTheLegsLengthAndTheFootsRadius) {
  // Thigh and shank at +-0.8 rad from the vertical: 2 * 0.213 * cos(0.8) + 0.02 = 0.3168 m.
  const RobotDescription robot = test::make_quadruped();
  StanceFeet feet;
  for (int leg = 0; leg < kNumLegs; ++leg) {
    feet.push_back(
        stance_foot(robot.legs[static_cast<std::size_t>(leg)], leg, standing_pose(), Eigen::Vector3d::UnitZ()));
  }
  EXPECT_NEAR(*height_from_feet(feet, Eigen::Vector3d::UnitZ()), 2.0 * 0.213 * std::cos(0.8) + 0.02, kExactTol);
}

}  // namespace
}  // namespace patrol::localize::leg_odometry_test
