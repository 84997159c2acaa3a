#include <cmath>
#include <string>

#include <Eigen/Geometry>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/error.h"
#include "core/leg_kinematics.h"
#include "core/random.h"
#include "io/urdf.h"
#include "tests/support/legged_urdf.h"
#include "tests/support/pose_near.h"
#include "tests/support/temporary_file.h"

namespace patrol::io::urdf_legs_test {
namespace {

using test::UrdfQuadruped;
using test::VectorNear;
using testing::HasSubstr;

RobotDescription describe(const std::string& text) {
  return load_robot_description(test::TemporaryFile("legs.urdf", text).path());
}

/// Returns the error text of a description in which the first `old` behind `after` is replaced.
std::string refusal_of(std::string text, const std::string& old, const std::string& by, const std::string& after = "") {
  const std::size_t at = text.find(old, text.find(after));
  if (at == std::string::npos) return "the description no longer has " + old;
  try {
    describe(text.replace(at, old.size(), by));
  } catch (const InputError& error) {
    return error.what();
  }
  return "accepted";
}

UrdfQuadruped in_actuator_frames() { return {.knee_offset_m = 0.03, .frames = test::actuator_frames()}; }

Eigen::Vector3d random_angles(const RobotDescription& robot, int leg, const RandomStream& stream, std::uint64_t i) {
  Eigen::Vector3d angles;
  for (int k = 0; k < 3; ++k) {
    const JointLimit& limit = robot.joint_limits[static_cast<std::size_t>(3 * leg + k)];
    angles[k] =
        limit.lower_rad + (limit.upper_rad - limit.lower_rad) * stream.uniform(i, static_cast<std::uint64_t>(k));
  }
  return angles;
}

TEST(UrdfLegs, PlainLegsHaveNoChainAndTheirLengths) {
  const RobotDescription robot = describe(UrdfQuadruped{}.text());
  ASSERT_EQ(robot.legs.size(), 4U);
  const std::array<const char*, 4> corners = {"FL", "FR", "RL", "RR"}, names = {"alpha", "beta", "gamma", "delta"};
  for (int leg = 0; leg < 4; ++leg) {
    const auto index = static_cast<std::size_t>(leg);
    const LegGeometry& found = robot.legs[index];
    const LegGeometry expected = UrdfQuadruped{}.plain_leg(leg);
    EXPECT_FALSE(found.chain);
    EXPECT_EQ(found.name, corners[index]);
    EXPECT_EQ(found.foot_link, names[index] + std::string("_tip"));
    EXPECT_THAT(found.hip_in_body, VectorNear(expected.hip_in_body, 1e-12));
    EXPECT_NEAR(found.abduction_offset_m, expected.abduction_offset_m, 1e-12);
    EXPECT_NEAR(found.thigh_m, 0.22, 1e-12);
    EXPECT_NEAR(found.shank_m, 0.23, 1e-12);
    EXPECT_NEAR(found.foot_radius_m, 0.022, 1e-12);
    EXPECT_EQ(robot.joint_names[3 * index], names[index] + std::string("_0_motor"));
    EXPECT_EQ(robot.joint_names[3 * index + 2], names[index] + std::string("_2_motor"));
  }
}

TEST(UrdfLegs, LegsInAnyFramesMoveTheFootAsPlainOnesTo1Nanometer) {
  const UrdfQuadruped quadruped = in_actuator_frames();
  const RobotDescription robot = describe(quadruped.text());
  const RandomStream stream(1, "test/legs");
  for (int leg = 0; leg < 4; ++leg) {
    const LegGeometry& chain = robot.legs[static_cast<std::size_t>(leg)];
    ASSERT_TRUE(chain.chain);
    const LegGeometry plain = quadruped.plain_leg(leg);
    for (std::uint64_t i = 0; i < 50; ++i) {
      const Eigen::Vector3d angles = random_angles(robot, leg, stream, i);
      const Eigen::Vector3d plain_angles = quadruped.plain_angles(angles);
      EXPECT_THAT(foot_position(chain, angles), VectorNear(foot_position(plain, plain_angles), 1e-9));
      const Eigen::Vector3d rates(stream.uniform(i, 4), stream.uniform(i, 5), -stream.uniform(i, 6));
      const Eigen::Vector3d plain_rates = quadruped.plain_angles(rates) - quadruped.plain_angles({0.0, 0.0, 0.0});
      EXPECT_THAT(Eigen::Vector3d(foot_jacobian(chain, angles) * rates),
                  VectorNear(foot_jacobian(plain, plain_angles) * plain_rates, 1e-9));
      EXPECT_THAT(shank_rate(chain, angles, rates), VectorNear(shank_rate(plain, plain_angles, plain_rates), 1e-9));
    }
  }
}

TEST(UrdfLegs, AHipAboveTheAbductionMovesTheFootByItsOwnOrder) {
  UrdfQuadruped quadruped;
  quadruped.is_hip_first = true;
  const RobotDescription robot = describe(quadruped.text());
  const LegGeometry& leg = robot.legs[1];
  ASSERT_TRUE(leg.chain);
  const double hip = 0.7, abduction = -0.3, knee = -1.1;
  using Eigen::AngleAxisd;
  using Eigen::Vector3d;
  const Vector3d shank = AngleAxisd(knee, Vector3d::UnitY()) * Vector3d(0, 0, -0.23);
  const Vector3d below = AngleAxisd(abduction, Vector3d::UnitX()) * (Vector3d(0, 0, -0.22) + shank);
  const Vector3d expected =
      Vector3d(0.21, -0.06, 0.0) + AngleAxisd(hip, Vector3d::UnitY()) * (Vector3d(0, -0.08, 0) + below);
  EXPECT_THAT(foot_position(leg, {hip, abduction, knee}), VectorNear(expected, 1e-9));
}

struct Variant {
  const char* name;
  UrdfQuadruped quadruped;
  double knee_sign;
};

std::vector<Variant> variants() {
  UrdfQuadruped hip_first;
  hip_first.is_hip_first = true;
  hip_first.frames = test::actuator_frames();
  UrdfQuadruped forward;
  forward.knee_lower_rad = 0.3;
  forward.knee_upper_rad = 2.7;
  UrdfQuadruped both_ways;
  both_ways.knee_lower_rad = -2.7;
  both_ways.knee_upper_rad = 2.7;
  UrdfQuadruped bent_forward = both_ways, bent_backward = both_ways;
  bent_forward.frames[2].zero_rad = 0.3;
  bent_backward.frames[2].zero_rad = -0.3;
  return {{"plain", {}, -1.0},
          {"in actuator frames", in_actuator_frames(), -1.0},
          {"hip first", hip_first, -1.0},
          {"knees forward", forward, 1.0},
          {"knees both ways", both_ways, -1.0},
          {"knees both ways, bent forward at zero", bent_forward, 1.0},
          {"knees both ways, bent backward at zero", bent_backward, -1.0}};
}

TEST(UrdfLegs, StandsWithTheFeetBelowTheHipsAt70PercentOfTheLegWithin1Millimeter) {
  for (const Variant& variant : variants()) {
    SCOPED_TRACE(variant.name);
    const RobotDescription robot = describe(variant.quadruped.text());
    for (std::size_t leg = 0; leg < 4; ++leg) {
      const LegGeometry& geometry = robot.legs[leg];
      const Eigen::Vector3d plain = variant.quadruped.plain_angles(geometry.standing_rad);
      EXPECT_NEAR(plain[0], 0.0, 1e-3);
      EXPECT_GT(variant.knee_sign * plain[2], 0.5);
      const LegGeometry expected = variant.quadruped.plain_leg(static_cast<int>(leg));
      const Eigen::Vector3d foot = foot_position(geometry, geometry.standing_rad);
      const Eigen::Vector3d below =
          expected.hip_in_body + Eigen::Vector3d(0, expected.abduction_offset_m, -std::cos(0.8) * 0.45);
      EXPECT_THAT(foot, VectorNear(below, 1e-3));
      EXPECT_NEAR(geometry.hip_in_body.x(), foot.x(), 1e-3);
      EXPECT_NEAR(geometry.hip_in_body.y() + geometry.abduction_offset_m, foot.y(), 1e-3);
      EXPECT_NEAR(geometry.length_m(), 0.45, 1e-9);
      for (int k = 0; k < 3; ++k) {
        EXPECT_GT(geometry.standing_rad[k], robot.joint_limits[3 * leg + static_cast<std::size_t>(k)].lower_rad);
        EXPECT_LT(geometry.standing_rad[k], robot.joint_limits[3 * leg + static_cast<std::size_t>(k)].upper_rad);
      }
    }
    EXPECT_NEAR(robot.body_height_m(), std::cos(0.8) * 0.45 + 0.022, 1e-3);
  }
}

TEST(UrdfLegs, AWeakKneeStandsStraighterSoThatTheWeightTakes60PercentOfItsTorque) {
  UrdfQuadruped weak;
  weak.knee_effort_nm = 20.0;
  const RobotDescription robot = describe(weak.text());
  const LegGeometry& leg = robot.legs[0];
  const double knee_x = leg.hip_in_body.x() - leg.thigh_m * std::sin(leg.standing_rad[1]);
  const double lever_m = std::abs(knee_x - foot_position(leg, leg.standing_rad).x());
  EXPECT_LE(0.5 * robot.mass_kg * 9.81 * lever_m, 0.6 * 20.0 + 0.2);
  EXPECT_GE(0.5 * robot.mass_kg * 9.81 * lever_m, 0.5 * 20.0);
  EXPECT_GT(robot.body_height_m(), std::cos(0.8) * 0.45 + 0.03);
}

TEST(UrdfLegs, TheFootprintHoldsTrunkAndFeet) {
  const RobotDescription robot = describe(UrdfQuadruped{}.text());
  double front_m = 0.0, side_m = 0.0;
  for (const Eigen::Vector2d& corner : robot.footprint_m) {
    front_m = std::max(front_m, corner.x());
    side_m = std::max(side_m, corner.y());
  }
  EXPECT_NEAR(front_m, 0.5 * (0.42 + 0.05), 1e-3);
  EXPECT_NEAR(side_m, 0.06 + 0.08 + 0.022, 2e-3);
}

TEST(UrdfLegs, BrokenLegsAreRefusedWithOneLine) {
  const std::string text = UrdfQuadruped{}.text();
  EXPECT_THAT(refusal_of(text, "<sphere radius=\"0.022\"/>", "<box size=\"0.1 0.1 0.1\"/>"),
              HasSubstr("alpha_2: no foot: this link, or one fixed to it, must have a sphere"));
  EXPECT_THAT(refusal_of(text, "type=\"revolute\"", "type=\"fixed\""), HasSubstr("nor four legs"));
  EXPECT_THAT(refusal_of(text, "type=\"revolute\"", "type=\"fixed\""), HasSubstr("(3 found)"));
  EXPECT_THAT(
      refusal_of(text, "xyz=\"0.000000000000 1.000000000000 0.000000000000\"", "xyz=\"0 0 1\"", "alpha_1_motor"),
      HasSubstr("the joints of a leg must be one about x and one about y of base_link"));
  EXPECT_THAT(refusal_of(text, "xyz=\"-0.210000000000 0.060000000000 0.000000000000\"", "xyz=\"0.3 0.06 0\""),
              HasSubstr("is at the same corner of the robot as"));
  UrdfQuadruped stiff;
  stiff.knee_lower_rad = -0.05;
  stiff.knee_upper_rad = 0.05;
  EXPECT_THAT(refusal_of(stiff.text(), "<robot", "<robot"),
              HasSubstr("the limits of the joints allow no posture with the foot below the hip"));
  const std::string tail =
      "<joint name=\"tail_joint\" type=\"revolute\"><parent link=\"base_link\"/><child link=\"tail\"/><axis xyz=\"0 0 "
      "1\"/><limit lower=\"-1\" upper=\"1\" effort=\"1\" velocity=\"1\"/></joint><link name=\"tail\"><inertial><mass "
      "value=\"1\"/><inertia ixx=\"1\" iyy=\"1\" izz=\"1\" ixy=\"0\" ixz=\"0\" iyz=\"0\"/></inertial></link></robot>";
  EXPECT_THAT(refusal_of(text, "</robot>", tail), HasSubstr("tail_joint: is not a joint of a leg: must be fixed"));
}

}  // namespace
}  // namespace patrol::io::urdf_legs_test
