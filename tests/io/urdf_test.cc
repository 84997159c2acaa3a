#include "io/urdf.h"

#include <set>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/error.h"
#include "core/leg_kinematics.h"
#include "tests/support/pose_near.h"
#include "tests/support/temporary_file.h"

namespace patrol::io::urdf_test {
namespace {

using test::TemporaryFile, test::VectorNear;
using ::testing::HasSubstr, ::testing::MatchesRegex, ::testing::StartsWith;

const std::string kQuadruped = PATROL_SOURCE_DIR "/models/quadruped/quadruped.urdf";

/// The quadruped's file with the first `old` behind `after` replaced.
std::string changed(const std::string& old, const std::string& by, const std::string& after = "") {
  std::string text = test::read_bytes(kQuadruped);
  const std::size_t from = text.find(after);
  const std::size_t at = text.find(old, from);
  if (from == std::string::npos || at == std::string::npos) ADD_FAILURE() << "the URDF no longer holds " << old;
  else text.replace(at, old.size(), by);
  return text;
}

std::string complaint_about(const std::string& text) {
  const TemporaryFile file("q.urdf", text);
  try {
    load_robot_description(file.path());
  } catch (const InputError& error) {
    const std::string what = error.what();
    EXPECT_EQ(what.find('\n'), std::string::npos) << "one line";
    return what.substr(std::min(what.size(), what.find("q.urdf")));
  }
  return "";
}

// The figures that the file's head cites.
TEST(Quadruped, WeighsThirteenPointFiveSixKilograms) {
  EXPECT_NEAR(load_robot_description(kQuadruped).mass_kg, 13.56, 0.005);
}

TEST(Quadruped, HasFourLegsOfThreeJointsInOrder) {
  const RobotDescription robot = load_robot_description(kQuadruped);
  ASSERT_EQ(robot.legs.size(), 4U);
  ASSERT_EQ(robot.joint_names.size(), 12U);
  ASSERT_EQ(robot.joint_limits.size(), 12U);
  const std::vector<std::string> names = {"FL", "FR", "RL", "RR"};
  for (std::size_t leg = 0; leg < 4; ++leg) {
    const LegGeometry& geometry = robot.legs[leg];
    const double front = leg < 2 ? 1.0 : -1.0, left = leg % 2 == 0 ? 1.0 : -1.0;
    EXPECT_EQ(geometry.name, names[leg]);
    EXPECT_THAT(geometry.hip_in_body, VectorNear(Eigen::Vector3d(front * 0.376 / 2, left * 0.0935 / 2, 0.0), 1e-3));
    EXPECT_NEAR(geometry.abduction_offset_m, left * 0.08, 1e-9);
    EXPECT_NEAR(geometry.thigh_m, 0.213, 1e-9);
    EXPECT_NEAR(geometry.shank_m, 0.213, 1e-9);
    EXPECT_EQ(robot.joint_names[3 * leg], names[leg] + "_abduction_joint");
    EXPECT_EQ(robot.joint_names[3 * leg + 1], names[leg] + "_hip_joint");
    EXPECT_EQ(robot.joint_names[3 * leg + 2], names[leg] + "_knee_joint");
    EXPECT_NEAR(robot.joint_limits[3 * leg].effort_nm, 23.7, 1e-9);
    EXPECT_NEAR(robot.joint_limits[3 * leg + 2].effort_nm, 35.55, 1e-9);
    EXPECT_NEAR(robot.joint_limits[3 * leg + 2].velocity_radps, 20.06, 1e-9);
  }
}

TEST(Quadruped, StandsOnFeetWithinItsFootprint) {
  const RobotDescription robot = load_robot_description(kQuadruped);
  const auto& hull = robot.footprint_m;
  ASSERT_GE(hull.size(), 4U);
  const auto is_inside = [&](const Eigen::Vector2d& p) {
    for (std::size_t i = 0; i < hull.size(); ++i) {
      const Eigen::Vector2d side = hull[(i + 1) % hull.size()] - hull[i], to = p - hull[i];
      if (side.x() * to.y() - side.y() * to.x() < 0.0) return false;
    }
    return true;
  };
  for (const LegGeometry& leg : robot.legs)
    EXPECT_TRUE(is_inside(foot_position(leg, {0.0, 0.8, -1.6}).head<2>())) << leg.name;
  EXPECT_FALSE(is_inside({0.5, 0.0}));
}

TEST(Quadruped, CarriesItsSensors) {
  const auto sensors = load_robot_description(kQuadruped).T_body_sensor;
  for (const char* name : {"lidar", "lidar3d", "imu", "tdlas", "gnss"}) EXPECT_TRUE(sensors.contains(name)) << name;
  EXPECT_THAT(sensors.at("lidar3d").position, VectorNear(Eigen::Vector3d(0.1, 0.0, 0.098), 1e-12));
}

const std::string kTracked = PATROL_SOURCE_DIR "/models/tracked/tracked.urdf";

/// What is said of the tracked robot's file with the first `old` behind `after` replaced.
std::string complaint_about_tracked(const std::string& old, const std::string& by, const std::string& after = "") {
  std::string text = test::read_bytes(kTracked);
  const std::size_t at = text.find(old, text.find(after));
  if (at == std::string::npos) {
    ADD_FAILURE() << "the URDF no longer holds " << old;
    return "";
  }
  return complaint_about(text.replace(at, old.size(), by));
}

TEST(Tracked, Weighs85KilogramsAndHasNoLegs) {
  const RobotDescription robot = load_robot_description(kTracked);
  EXPECT_NEAR(robot.mass_kg, 85.0, 0.05);
  EXPECT_TRUE(robot.legs.empty());
}

TEST(Tracked, TurnsItsAntennaAboutAPoint98CentimetresAboveTheGroundByTwoServosOfSixNewtonMetres) {
  const RobotDescription robot = load_robot_description(kTracked);
  ASSERT_TRUE(robot.antenna.has_value());
  EXPECT_NEAR(robot.antenna->T_body_mount.position.z() + robot.tracks->body_height_m, 0.98, 1e-9);
  EXPECT_EQ(robot.antenna->yaw.effort_nm, 6.0);
  EXPECT_LT(robot.antenna->pitch.lower_rad, robot.antenna->stowed_pitch_rad);
  // Yaw to the left, then pitch downwards: the axis points half left and 30 degrees down.
  const Eigen::Vector3d axis = robot.antenna->T_body_tem(M_PI / 4.0, M_PI / 6.0).rotation * Eigen::Vector3d::UnitX();
  EXPECT_THAT(axis, VectorNear(Eigen::Vector3d(std::sqrt(0.375), std::sqrt(0.375), -0.5), 1e-12));
  EXPECT_FALSE(load_robot_description(kQuadruped).antenna.has_value());
}

TEST(Tracked, AnAntennaWhoseAxesDoNotMeetOrThatCannotBeStowedIsRefused) {
  EXPECT_THAT(complaint_about_tracked("<origin xyz=\"0 0 0\"/>", "<origin xyz=\"0 0 0.1\"/>", "tem_pitch_joint"),
              HasSubstr("tem_pitch_joint: must have no <origin>"));
  EXPECT_THAT(complaint_about_tracked("lower=\"-1.62\"", "lower=\"-1.5\"", "tem_pitch_joint"),
              HasSubstr("tem_pitch_joint: lower limit must reach -90 degrees"));
  EXPECT_THAT(complaint_about_tracked("<axis xyz=\"0 0 1\"/>", "<axis xyz=\"0 1 0\"/>", "tem_yaw_joint"),
              HasSubstr("tem_yaw_joint: must be revolute"));
}

TEST(Tracked, HasTracks55CentimetresApartWith60CentimetresOnTheGround) {
  const RobotDescription robot = load_robot_description(kTracked);
  ASSERT_TRUE(robot.tracks.has_value());
  EXPECT_NEAR(robot.tracks->gauge_m, 0.55, 1e-9);
  EXPECT_NEAR(robot.tracks->width_m, 0.15, 1e-9);
  EXPECT_NEAR(robot.tracks->contact_length_m, 0.60, 1e-9);
  EXPECT_NEAR(robot.tracks->sprocket_radius_m, 0.07, 1e-9);
}

TEST(Tracked, ItsSprocketsTurnWithoutEndLeftFirst) {
  const RobotDescription robot = load_robot_description(kTracked);
  EXPECT_THAT(robot.joint_names, ::testing::ElementsAre("left_sprocket_joint", "right_sprocket_joint"));
  ASSERT_EQ(robot.joint_limits.size(), 2U);
  for (const JointLimit& limit : robot.joint_limits) {
    EXPECT_TRUE(std::isinf(limit.lower_rad) && std::isinf(limit.upper_rad));
    EXPECT_DOUBLE_EQ(limit.effort_nm, 45.0);
    EXPECT_DOUBLE_EQ(limit.velocity_radps, 18.7);
  }
}

TEST(Tracked, ItsFootprintIs1MetreBy70Centimetres) {
  const auto hull = load_robot_description(kTracked).footprint_m;
  Eigen::Vector2d lower(0.0, 0.0), upper(0.0, 0.0);
  for (const Eigen::Vector2d& corner : hull) {
    lower = lower.cwiseMin(corner);
    upper = upper.cwiseMax(corner);
  }
  EXPECT_THAT(upper, VectorNear(Eigen::Vector2d(0.50, 0.35), 1e-9));
  EXPECT_THAT(lower, VectorNear(Eigen::Vector2d(-0.50, -0.35), 1e-9));
}

TEST(Tracked, CarriesItsSensorsWithTheLidar55CentimetresAboveTheGround) {
  const RobotDescription robot = load_robot_description(kTracked);
  for (const char* name : {"lidar", "imu", "uwb", "depth_camera", "ultrasonic_0", "ultrasonic_7"})
    EXPECT_NO_THROW(robot.T_body(name)) << name;
  EXPECT_NEAR(robot.T_body("lidar").position.z() + 0.15, 0.55, 1e-9);
}

TEST(Tracked, WhatIsWrongWithATrackIsNamed) {
  EXPECT_THAT(complaint_about_tracked("<cylinder radius=\"0.075\" length=\"0.15\"/>", "<sphere radius=\"0.075\"/>",
                                      "<collision name=\"left_wheel_0\""),
              HasSubstr("left_track: collision shapes of a track must be its wheels"));
  EXPECT_THAT(complaint_about_tracked("rpy=\"1.571 0 0\"", "rpy=\"0 0 0\"", "<collision name=\"right_wheel_3\""),
              HasSubstr("right_track: collision shapes of a track must be its wheels"));
  EXPECT_THAT(complaint_about_tracked("xyz=\"0 0.275 0\"", "xyz=\"0 -0.275 0\""), HasSubstr("must be to the left"));
  EXPECT_THAT(complaint_about_tracked("effort=\"45\"", "effort=\"0\""),
              HasSubstr("left_sprocket_joint: limit effort and velocity must be positive"));
}

TEST(Urdf, AMissingLinkIsNamedWithItsLine) {
  EXPECT_THAT(complaint_about(changed("<child link=\"imu\"/>", "<child link=\"gyro\"/>")),
              MatchesRegex("q.urdf:[0-9]+: gyro: unknown link: child of a joint"));
  EXPECT_THAT(complaint_about(changed("<parent link=\"base_link\"/>", "<parent link=\"trunk\"/>")),
              MatchesRegex("q.urdf:[0-9]+: trunk: unknown link: parent of a joint"));
}

TEST(Urdf, NotANumberAndInfinityAreNamedWithTheirLine) {
  for (const char* bad : {"nan", "NaN", "inf", "-inf", "Infinity"}) {
    EXPECT_THAT(complaint_about(changed("<mass value=\"5.2\"/>", std::string("<mass value=\"") + bad + "\"/>")),
                MatchesRegex("q.urdf:[0-9]+: .*: must be finite numbers"))
        << bad;
    EXPECT_THAT(complaint_about(changed("xyz=\"0.1 0 0.098\"", std::string("xyz=\"0.1 ") + bad + " 0.098\"")),
                MatchesRegex("q.urdf:[0-9]+: .*: must be finite numbers"))
        << bad;
  }
}

TEST(Urdf, WordsThatOnlyBeginLikeNanOrInfAreNoNumbers) {
  EXPECT_EQ(complaint_about(changed("<robot name=\"quadruped\">", "<robot name=\"nancy in information\">")), "");
}

TEST(Urdf, MassesMustBePositive) {
  EXPECT_THAT(complaint_about(changed("<mass value=\"5.2\"/>", "<mass value=\"-5.2\"/>")),
              MatchesRegex("q.urdf:[0-9]+: base_link: mass must be positive"));
  EXPECT_THAT(complaint_about(changed("<mass value=\"5.2\"/>", "<mass value=\"0\"/>")),
              HasSubstr("base_link: mass must be positive"));
}

TEST(Urdf, InertiasMustBeThoseOfABody) {
  EXPECT_THAT(complaint_about(changed("ixx=\"0.0116567\"", "ixx=\"-0.0116567\"")),
              HasSubstr("base_link: invalid inertia: principal moments"));
  EXPECT_THAT(complaint_about(changed("ixx=\"0.0116567\"", "ixx=\"0.2\"")),
              HasSubstr("base_link: invalid inertia: principal moments"))
      << "more than the two others";
}

TEST(Urdf, AThinRodsZeroMomentIsRefusedToo) {
  std::string text = changed("ixx=\"0.0116567\"", "ixx=\"0\"");
  const std::string iyy = "iyy=\"0.0656615\"", izz_value = "0.0686515";
  ASSERT_NE(text.find(iyy), std::string::npos);
  text.replace(text.find(iyy), iyy.size(), "iyy=\"" + izz_value + "\"");
  EXPECT_THAT(complaint_about(text), HasSubstr("base_link: invalid inertia: principal moments"));
}

TEST(Urdf, JointsThatGoRoundInACircleAreRefused) {
  EXPECT_THAT(complaint_about(changed("<parent link=\"base_link\"/>", "<parent link=\"FL_shank\"/>",
                                      "name=\"FL_abduction_joint\"")),
              MatchesRegex("q.urdf:[0-9]+: FL_[a-z]+: the joints form a cycle"));
}

TEST(Urdf, ALinkWithTwoParentsIsRefused) {
  const std::string second =
      "<joint name=\"loop\" type=\"fixed\"><parent link=\"RR_foot\"/><child "
      "link=\"FL_foot\"/></joint></robot>";
  EXPECT_THAT(complaint_about(changed("</robot>", second)),
              MatchesRegex("q.urdf:[0-9]+: FL_foot: child of two joints: only one is allowed"));
}

TEST(Urdf, LimitsMustLeaveRoom) {
  std::string text = test::read_bytes(kQuadruped);
  const std::size_t joint = text.find("name=\"FL_knee_joint\""), at = text.find("lower=\"", joint);
  ASSERT_NE(at, std::string::npos);
  text.insert(at + 7, "9");
  text.erase(at + 8, text[at + 8] == '-' ? 1 : 0);
  EXPECT_THAT(complaint_about(text),
              MatchesRegex("q.urdf:[0-9]+: FL_knee_joint: limit lower = .*: must be below upper = .*"));
}

TEST(Urdf, AFileCutShortOrNotThereIsRefused) {
  const std::string whole = test::read_bytes(kQuadruped);
  EXPECT_THAT(complaint_about(whole.substr(0, whole.size() / 2)), StartsWith("q.urdf:"));
  EXPECT_THAT(complaint_about("no XML at all"), StartsWith("q.urdf:"));
  EXPECT_THAT(complaint_about(""), StartsWith("q.urdf:"));
  EXPECT_THROW(load_robot_description("/nowhere/q.urdf"), InputError);
  EXPECT_THROW(load_robot_description("/tmp"), InputError);
}

}  // namespace
}  // namespace patrol::io::urdf_test
