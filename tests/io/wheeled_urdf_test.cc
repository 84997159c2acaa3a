#include "tests/support/wheeled_urdf.h"

#include <algorithm>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/error.h"
#include "core/wheel_kinematics.h"
#include "io/urdf.h"
#include "tests/support/pose_near.h"
#include "tests/support/temporary_file.h"

namespace patrol::io {
namespace {

using test::TemporaryFile, test::UrdfRobot, test::VectorNear;
using ::testing::HasSubstr;

RobotDescription load(const std::string& text) {
  return load_robot_description(TemporaryFile("wheels.urdf", text).path());
}

RobotDescription load(const UrdfRobot& robot) { return load(robot.text()); }

std::string error_of(const std::string& text) {
  try {
    load(text);
  } catch (const InputError& error) {
    EXPECT_EQ(std::string(error.what()).find('\n'), std::string::npos) << "one line";
    return error.what();
  }
  return "";
}

const WheelGeometry& wheel_of(const RobotDescription& robot, const std::string& link) {
  return *std::find_if(robot.wheels.begin(), robot.wheels.end(),
                       [&](const WheelGeometry& wheel) { return wheel.link == link; });
}

TEST(WheeledRobot, Weighs50KilogramsOnFourWheelsOfTheDataSheet) {
  const RobotDescription robot = load_robot_description(PATROL_SOURCE_DIR "/models/wheeled/wheeled.urdf");
  EXPECT_NEAR(robot.mass_kg, 50.0, 1e-6);
  ASSERT_EQ(robot.wheels.size(), 4U);
  EXPECT_TRUE(robot.legs.empty());
  EXPECT_FALSE(robot.tracks);
  const DifferentialGeometry geometry = differential_geometry(robot);
  EXPECT_NEAR(geometry.gauge_m, 0.5708, 1e-9);
  EXPECT_NEAR(geometry.contact_length_m, 0.512, 1e-9);
  EXPECT_NEAR(geometry.rolling_radius_m, 0.1651, 1e-9);
  EXPECT_NEAR(robot.body_height_m(), 0.1323, 1e-9);
}

TEST(WheeledRobot, ItsFootprintIs99By69CentimetersAndItsLidar55CentimetersAboveTheGround) {
  const RobotDescription robot = load_robot_description(PATROL_SOURCE_DIR "/models/wheeled/wheeled.urdf");
  Eigen::AlignedBox2d box;
  for (const Eigen::Vector2d& corner : robot.footprint_m) box.extend(corner);
  EXPECT_NEAR(box.sizes().x(), 0.99, 0.005);
  EXPECT_NEAR(box.sizes().y(), 0.5708 + 0.1143, 0.005);
  EXPECT_NEAR(robot.T_body("lidar").position.z() + robot.body_height_m(), 0.55, 0.001);
}

TEST(WheeledUrdf, FindsTheWheelsOfADifferentialDriveWithoutTheirNames) {
  const RobotDescription robot = load(test::differential_urdf());
  ASSERT_EQ(robot.wheels.size(), 3U);
  EXPECT_EQ(wheel_drive_type(robot), WheelDriveType::kDifferential);
  EXPECT_THAT(wheel_of(robot, "port").center_in_body, VectorNear(Eigen::Vector3d(0.1, 0.25, -0.05), 1e-9));
  EXPECT_EQ(wheel_of(robot, "port").forward_sign, 1.0);
  EXPECT_EQ(wheel_of(robot, "starboard").forward_sign, -1.0);
  EXPECT_TRUE(wheel_of(robot, "trailing").is_caster);
  EXPECT_FALSE(wheel_of(robot, "trailing").drive_joint);
  EXPECT_THAT(robot.joint_names, ::testing::ElementsAre("port_roll", "starboard_roll"));
  EXPECT_NEAR(robot.body_height_m(), 0.2, 1e-9);
}

TEST(WheeledUrdf, FindsSteeringJointsAboveWheelsAfterTheDrivenWheels) {
  const RobotDescription robot = load(test::ackermann_urdf(1.0, 0.6, 0.5));
  EXPECT_EQ(wheel_drive_type(robot), WheelDriveType::kAckermann);
  EXPECT_THAT(robot.joint_names, ::testing::ElementsAre("rl_roll", "rr_roll", "fl_steer", "fr_steer"));
  EXPECT_EQ(wheel_of(robot, "fr").steering_joint, 3U);
  EXPECT_NEAR(robot.joint_limits[3].upper_rad, 0.5, 1e-9);
}

TEST(WheeledUrdf, AWheelFrameMayBeRotatedAboutTheAxis) {
  std::string text = test::skid_steer_urdf(0.5, 0.6).text();
  // The first wheel: joint frame rolled by a quarter turn, so that its axis is z of the link and the cylinder is along
  // it.
  text.replace(text.find(R"(<origin xyz="0.25 0.3 -0.05"/>)"), 30,
               R"(<origin xyz="0.25 0.3 -0.05" rpy="-1.5707963267948966 0 0"/>)");
  text.replace(text.find(R"(<axis xyz="0 1 0"/>)"), 19, R"(<axis xyz="0 0 1"/>)");
  text.replace(text.find(R"(<origin rpy="1.5707963267948966 0 0"/>)"), 38, "");
  const RobotDescription robot = load(text);
  EXPECT_NEAR(wheel_of(robot, "w0").radius_m, 0.15, 1e-9);
  EXPECT_EQ(wheel_of(robot, "w0").forward_sign, 1.0);
}

TEST(WheeledUrdf, FramesBehindSeveralFixedJointsHaveTheirPoseInBody) {
  std::string text = test::skid_steer_urdf(0.5, 0.6).text();
  text.insert(text.find("</robot>"),
              R"(<link name="camera"/><joint name="c" type="fixed"><parent link="lidar"/><child link="camera"/>
              <origin xyz="0.1 0.2 0.3"/></joint>)");
  EXPECT_THAT(load(text).T_body("camera").position, VectorNear(Eigen::Vector3d(0.1, 0.2, 0.3), 1e-12));
}

TEST(WheeledUrdf, MeshesInTheFootprintAreReadFromTheirFile) {
  const test::TemporaryFolder folder;
  test::write_bytes(folder / "bumper.obj",
                    "v 1 0.1 0\nv 1 -0.1 0\nv 1 0 0.1\nv 0 0 0\nf 1 2 3\nf 1 2 4\nf 2 3 4\nf 1 3 4\n");
  std::string text = test::skid_steer_urdf(0.5, 0.6).text();
  const std::string base = "<link name=\"base_link\">";
  text.insert(text.find(base) + base.size(),
              R"(<collision><geometry><mesh filename="bumper.obj"/></geometry></collision>)");
  test::write_bytes(folder / "robot.urdf", text);
  Eigen::AlignedBox2d box;
  for (const Eigen::Vector2d& corner : load_robot_description((folder / "robot.urdf").string()).footprint_m)
    box.extend(corner);
  EXPECT_NEAR(box.max().x(), 1.0, 1e-9);
}

TEST(WheeledUrdf, ErrorsNameTheElement) {
  const auto changed = [](const std::string& old, const std::string& by) {
    std::string text = test::skid_steer_urdf(0.5, 0.6).text();
    const std::size_t at = text.find(old);
    if (at == std::string::npos) ADD_FAILURE() << old;
    else text.replace(at, old.size(), by);
    return text;
  };
  EXPECT_THAT(error_of(changed(R"(<axis xyz="0 1 0"/>)", R"(<axis xyz="1 0 0"/>)")),
              HasSubstr("w0_roll: the axis of a wheel must be along y of base_link"));
  EXPECT_THAT(error_of(changed(R"(<cylinder radius="0.15" length="0.08"/>)", R"(<box size="0.3 0.1 0.3"/>)")),
              HasSubstr("w0: the collision shape of a wheel must be a cylinder or a sphere"));
  EXPECT_THAT(error_of(changed(R"(<origin rpy="1.5707963267948966 0 0"/>)", "")),
              HasSubstr("w0: the collision cylinder of a wheel must be about the axis of its joint"));
  EXPECT_THAT(error_of(changed(R"(<origin xyz="0.25 0.3 -0.05"/>)", R"(<origin xyz="0.25 0.3 0.1"/>)")),
              HasSubstr("w0: is 0.150 m above the lowest wheel: all wheels must touch one plane"));
  EXPECT_THAT(error_of(changed(R"(<limit effort="30" velocity="20"/>)", R"(<limit effort="0" velocity="20"/>)")),
              HasSubstr("w0_roll: limit effort and velocity must be positive"));
}

TEST(WheeledUrdf, AJointThatSteersTwoWheelsIsRefused) {
  std::string text = test::ackermann_urdf(1.0, 0.6, 0.5).text();
  const std::string parent = R"(<parent link="fr_carrier"/>)";
  text.replace(text.find(parent), parent.size(), R"(<parent link="fl_carrier"/>)");
  EXPECT_THAT(error_of(text), HasSubstr("fl_steer: steers several wheels"));
}

TEST(WheeledUrdf, WheelsWithoutMotorsOrOnOneSideAreRefused) {
  UrdfRobot robot = test::skid_steer_urdf(0.5, 0.6);
  for (test::UrdfWheel& wheel : robot.wheels) wheel.is_driven = false;
  EXPECT_THAT(error_of(robot.text()), HasSubstr("no wheel has a motor"));
  robot = test::skid_steer_urdf(0.5, 0.6);
  robot.wheels[1].is_driven = robot.wheels[3].is_driven = false;
  EXPECT_THAT(error_of(robot.text()), HasSubstr("on both sides"));
}

}  // namespace
}  // namespace patrol::io
