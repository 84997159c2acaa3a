#include "importer/robot/robot_import.h"

#include <chrono>
#include <cstdlib>
#include <filesystem>
#include <string>
#include <utility>

#include <Eigen/Core>
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/error.h"
#include "core/wheel_kinematics.h"
#include "io/urdf.h"
#include "tests/importer/robot/description.h"
#include "tests/importer/robot/import.h"
#include "tests/support/pose_near.h"
#include "tests/support/temporary_file.h"

namespace patrol::importer::robot_import_test {
namespace {

using test::TemporaryFolder, test::VectorNear;
using ::testing::HasSubstr, ::testing::Not;

/// Expects the bounding box of the footprint.
void expect_footprint(const RobotDescription& robot, double min_x, double max_x, double min_y, double max_y) {
  Eigen::Vector2d lower(1e9, 1e9), upper(-1e9, -1e9);
  for (const Eigen::Vector2d& corner : robot.footprint_m) {
    lower = lower.cwiseMin(corner);
    upper = upper.cwiseMax(corner);
  }
  EXPECT_THAT(lower, VectorNear(Eigen::Vector2d(min_x, min_y), 0.005));
  EXPECT_THAT(upper, VectorNear(Eigen::Vector2d(max_x, max_y), 0.005));
}

std::string four_wheels(double radius_m, double width_m) {
  std::string text;
  for (const auto& [name, xyz] : {std::pair{"fl", "0.2 0.25 -0.05"},
                                  {"fr", "0.2 -0.25 -0.05"},
                                  {"rl", "-0.2 0.25 -0.05"},
                                  {"rr", "-0.2 -0.25 -0.05"}})
    text += wheel(name, "base_link", xyz, radius_m, width_m);
  return text;
}

TEST(ImportRobot, ADifferentialDriveWithACasterKeepsWheelsMassAndFootprint) {
  Import import(robot(chassis() + two_wheels() + caster()));
  const RobotDescription& robot = import.load();
  ASSERT_EQ(robot.wheels.size(), 3U);
  expect_wheel(import, "left", {0.0, 0.25, -0.05}, 0.1, 0.04);
  expect_wheel(import, "right", {0.0, -0.25, -0.05}, 0.1, 0.04);
  expect_wheel(import, "small", {-0.28, 0.0, -0.1}, 0.05, 0.03);
  EXPECT_TRUE(import.wheel("small").is_caster);
  EXPECT_FALSE(import.wheel("small").drive_joint.has_value());
  EXPECT_TRUE(import.wheel("left").drive_joint.has_value());
  EXPECT_EQ(wheel_drive_type(robot), WheelDriveType::kDifferential);
  EXPECT_NEAR(robot.mass_kg, 22.5, 1e-6);
  EXPECT_NEAR(robot.joint_limits[*import.wheel("left").drive_joint].effort_nm, 10.0, 1e-9);
  expect_footprint(robot, -0.33, 0.3, -0.27, 0.27);
  EXPECT_EQ(robot.name, "imported");
}

TEST(ImportRobot, ACenterOfMassBesideTheContactsIsReported) {
  Import import(robot(link("base_link", inertial(20.0, "0.1 0 0", 0.5) + shape("collision", box(0.6, 0.4, 0.2))) +
                      two_wheels() + caster()));
  import.load();
  EXPECT_THAT(import.assumptions(), HasSubstr("the robot tips over"));
  Import balanced(robot(link("base_link", inertial(20.0, "-0.1 0 0", 0.5) + shape("collision", box(0.6, 0.4, 0.2))) +
                        two_wheels() + caster()));
  balanced.load();
  EXPECT_THAT(balanced.assumptions(), Not(HasSubstr("the robot tips over")));
}

TEST(ImportRobot, FourFixedWheelsAreADifferentialDrive) {
  Import import(robot(chassis() + four_wheels(0.1, 0.05)));
  const RobotDescription& robot = import.load();
  ASSERT_EQ(robot.wheels.size(), 4U);
  EXPECT_EQ(robot.joint_names.size(), 4U);
  expect_wheel(import, "rr", {-0.2, -0.25, -0.05}, 0.1, 0.05);
  EXPECT_EQ(wheel_drive_type(robot), WheelDriveType::kDifferential);
  EXPECT_NEAR(robot.mass_kg, 24.0, 1e-6);
  EXPECT_THAT(import.robot.settings, HasSubstr("kinematics: differential"));
}

TEST(ImportRobot, SixWheelsAreKept) {
  Import import(robot(chassis() + four_wheels(0.1, 0.05) + wheel("ml", "base_link", "0 0.25 -0.05", 0.1, 0.05) +
                      wheel("mr", "base_link", "0 -0.25 -0.05", 0.1, 0.05)));
  EXPECT_EQ(import.load().wheels.size(), 6U);
}

std::string ackermann(const std::string& steering_axis) {
  std::string text = chassis();
  for (const auto& [side, y] : {std::pair{"l", "0.25"}, {"r", "-0.25"}}) {
    text += joint(std::string("steer_") + side, "revolute", "base_link", std::string("knuckle_") + side,
                  fmt::format("0.4 {} -0.05", y),
                  axis(steering_axis) + R"(<limit lower="-0.5" upper="0.6" effort="20" velocity="3"/>)");
    text += link(std::string("knuckle_") + side, inertial(0.5));
    text += wheel(std::string("f") + side, std::string("knuckle_") + side, "0 0 0", 0.1, 0.05, "");
    text += wheel(std::string("r") + side, "base_link", fmt::format("-0.1 {} -0.05", y), 0.1, 0.05);
  }
  return robot(text);
}

TEST(ImportRobot, SteeredFrontWheelsAreAnAckermannDrive) {
  Import import(ackermann("0 0 1"));
  const RobotDescription& robot = import.load();
  ASSERT_EQ(robot.wheels.size(), 4U);
  EXPECT_EQ(wheel_drive_type(robot), WheelDriveType::kAckermann);
  const WheelGeometry& front = import.wheel("fl");
  ASSERT_TRUE(front.steering_joint.has_value());
  EXPECT_FALSE(front.drive_joint.has_value());
  EXPECT_EQ(front.left_sign, 1.0);
  EXPECT_NEAR(robot.joint_limits[*front.steering_joint].lower_rad, -0.5, 1e-9);
  EXPECT_NEAR(robot.joint_limits[*front.steering_joint].upper_rad, 0.6, 1e-9);
  EXPECT_TRUE(import.wheel("rl").drive_joint.has_value());
  EXPECT_NEAR(robot.mass_kg, 25.0, 1e-6);
  expect_footprint(robot, -0.3, 0.5, -0.275, 0.275);
  EXPECT_THAT(import.robot.settings, HasSubstr("kinematics: ackermann"));
  // A quarter of the width of 0.55 m, and 0.13 m.
  EXPECT_THAT(import.robot.settings, HasSubstr("    costmap: {keep_out_margin_m: 0.26}\n"));
  EXPECT_THAT(import.assumptions(), HasSubstr("| keep-out lines | stay 0.26 m from the centers of the discs of its "
                                              "outline, and so 0.12 m from its sides |"));
}

TEST(ImportRobot, ASteeringAxisThatPointsDownKeepsItsSign) {
  Import import(ackermann("0 0 -1"));
  import.load();
  EXPECT_EQ(import.wheel("fl").left_sign, -1.0);
}

TEST(ImportRobot, TheDriveDifferentialFixesTheSteering) {
  Import import(ackermann("0 0 1"));
  import.options.drive = "differential";
  EXPECT_EQ(wheel_drive_type(import.load()), WheelDriveType::kDifferential);
  EXPECT_NEAR(import.description.mass_kg, 25.0, 1e-6);
}

TEST(ImportRobot, WheelsWithReversedAxesAndTurnedFramesAreFound) {
  const std::string turned = joint("l_joint", "continuous", "base_link", "l", "0 0.25 -0.05", axis("0 0 1") + kMotor,
                                   "-1.5707963267948966 0 0") +
                             link("l", inertial(1.0) + shape("collision", cylinder(0.1, 0.04), "0 0 0.01"));
  Import import(
      robot(chassis() + turned + wheel("r", "base_link", "0 -0.25 -0.05", 0.1, 0.04, kMotor, "0 -1 0") + caster()));
  import.load();
  expect_wheel(import, "l", {0.0, 0.26, -0.05}, 0.1, 0.04);
  expect_wheel(import, "r", {0.0, -0.25, -0.05}, 0.1, 0.04);
  EXPECT_EQ(import.wheel("l").forward_sign, 1.0);
  EXPECT_EQ(import.wheel("r").forward_sign, -1.0);
}

TEST(ImportRobot, NamesInAnotherLanguageOrWithAMeaningInPatrolDecideNothing) {
  std::string text =
      robot(chassis("车体") + two_wheels("车体") + caster("车体") +
            joint("tem_yaw_joint", "fixed", "车体", "left_track", "0 0 0.1") + link("left_track", inertial(0.5)) +
            joint("j & <k>", "fixed", "车体", "FL_foot", "0 0 0.1") + link("FL_foot", inertial(0.25)));
  for (std::size_t at = 0; (at = text.find("j & <k>", at)) != std::string::npos;)
    text.replace(at, 7, "j &amp; &lt;k&gt;");
  const auto rename = [&text](const std::string& from, const std::string& to) {
    for (std::size_t at = 0; (at = text.find("\"" + from + "\"", at)) != std::string::npos; at += to.size())
      text.replace(at, from.size() + 2, "\"" + to + "\"");
  };
  rename("left", "колесо");
  rename("right", "base_link");
  Import import(text);
  const RobotDescription& robot = import.load();
  EXPECT_EQ(robot.wheels.size(), 3U);
  expect_wheel(import, "колесо", {0.0, 0.25, -0.05}, 0.1, 0.04);
  expect_wheel(import, "base_link_part", {0.0, -0.25, -0.05}, 0.1, 0.04);
  EXPECT_NEAR(robot.mass_kg, 23.25, 1e-6);
  EXPECT_TRUE(robot.legs.empty());
  EXPECT_FALSE(robot.tracks.has_value());
  EXPECT_FALSE(robot.antenna.has_value());
}

TEST(ImportRobot, OffsetAndTurnedInertialFramesAreKept) {
  const std::string offset = R"(<inertial><origin xyz="0.1 0.02 -0.03" rpy="0.1 0.2 0.3"/><mass value="30"/>
    <inertia ixx="0.5" ixy="0.01" ixz="0.02" iyy="0.6" iyz="0.03" izz="0.7"/></inertial>)";
  Import import(robot(link("base_link", offset + shape("collision", box(0.6, 0.4, 0.2))) + two_wheels() + caster()));
  EXPECT_NEAR(import.load().mass_kg, 32.5, 1e-6);
  EXPECT_THAT(import.robot.urdf, HasSubstr(R"(<origin xyz="0.1 0.02 -0.03" rpy="0.1 0.2 0.3"/>)"));
  EXPECT_THAT(import.robot.urdf, HasSubstr(R"(ixx="0.5" ixy="0.01" ixz="0.02" iyy="0.6" iyz="0.03" izz="0.7")"));
}

TEST(ImportRobot, TheSettingsHaveTheSpeedOfTheSlowestWheelMotor) {
  std::string text = robot(chassis() + two_wheels() + caster());
  text.replace(text.find("velocity=\"12\""), 13, "velocity=\"7\"");
  Import import(text);
  import.load();
  EXPECT_THAT(import.robot.settings, HasSubstr("wheel_drive: {max_speed_mps: 0.70}"));
  EXPECT_THAT(import.robot.settings, HasSubstr("dwa: {max_speed_mps: 0.70,"));
  Import mecanum(robot(chassis() + four_wheels(0.1, 0.05)));
  mecanum.options.drive = "mecanum";
  mecanum.load();
  EXPECT_THAT(mecanum.robot.settings, HasSubstr("kinematics: omnidirectional"));
}

TEST(ImportRobot, AChassisThatDragsOnTheGroundIsReported) {
  Import import(robot(link("base_link", inertial(20.0, "-0.1 0 0", 0.5) + shape("collision", box(0.6, 0.4, 0.3))) +
                      two_wheels() + caster()));
  import.load();
  EXPECT_THAT(import.assumptions(),
              HasSubstr("| base_link | its collision shape is 0.000 m above the ground: it drags |"));
}

TEST(ImportRobot, AMimickingWheelHasAMotor) {
  const std::string follower = joint("fl_joint", "continuous", "base_link", "fl", "0.2 0.25 -0.05",
                                     axis("0 1 0") + R"(<mimic joint="left_joint"/>)") +
                               link("fl", inertial(1.0) + shape("collision", cylinder(0.1, 0.04), "0 0 0", kAcross)) +
                               wheel("fr", "base_link", "0.2 -0.25 -0.05", 0.1, 0.04, "");
  Import import(robot(chassis() + two_wheels() + follower));
  import.load();
  EXPECT_TRUE(import.wheel("fl").drive_joint.has_value());
  EXPECT_FALSE(import.wheel("fr").drive_joint.has_value());
  EXPECT_THAT(import.assumptions(), HasSubstr("has a motor: its &lt;mimic> follows a driven wheel"));
}

TEST(ImportRobot, MissingInertiasAreThoseOfTheShapes) {
  const std::string bare = joint("l_joint", "continuous", "base_link", "l", "0 0.25 -0.05", axis("0 1 0")) +
                           link("l", shape("collision", cylinder(0.1, 0.04), "0 0 0", kAcross)) +
                           joint("r_joint", "continuous", "base_link", "r", "0 -0.25 -0.05", axis("0 1 0")) +
                           link("r", shape("visual", cylinder(0.1, 0.04), "0 0 0", kAcross));
  Import import(robot(link("base_link", shape("visual", box(0.6, 0.4, 0.2))) + bare + caster()));
  const RobotDescription& robot = import.load();
  const double wheel_kg = 500.0 * M_PI * 0.01 * 0.04, body_kg = 500.0 * 0.6 * 0.4 * 0.2;
  EXPECT_NEAR(robot.mass_kg, body_kg + 2.0 * wheel_kg + 0.5, 1e-6);
  const JointLimit& limit = robot.joint_limits[*import.wheel("l").drive_joint];
  EXPECT_NEAR(limit.velocity_radps, 15.0, 1e-9);
  EXPECT_NEAR(limit.effort_nm, 1.5 * 0.8 * (body_kg + 0.5) * 9.81 * 0.1 / 2.0, 0.06 * limit.effort_nm);
  EXPECT_THAT(import.assumptions(), HasSubstr("the file names no motors"));
  EXPECT_THAT(import.assumptions(), HasSubstr("has no &lt;collision>"));
  expect_footprint(robot, -0.33, 0.3, -0.27, 0.27);
}

TEST(ImportRobot, ARobotThatFacesYIsTurned) {
  const std::string text = link("base_link", inertial(20.0, "0 0 0", 0.5) + shape("collision", box(0.4, 0.6, 0.2))) +
                           wheel("right", "base_link", "0.25 0 -0.05", 0.1, 0.04, kMotor, "1 0 0") +
                           wheel("left", "base_link", "-0.25 0 -0.05", 0.1, 0.04, kMotor, "1 0 0");
  std::string turned = text;
  for (std::size_t at = 0; (at = turned.find(kAcross, at)) != std::string::npos;)
    turned.replace(at, kAcross.size(), "0 1.5707963267948966 0");
  Import import(robot(turned));
  import.load();
  expect_wheel(import, "left", {0.0, 0.25, -0.05}, 0.1, 0.04);
  expect_wheel(import, "right", {0.0, -0.25, -0.05}, 0.1, 0.04);
  EXPECT_THAT(import.assumptions(), HasSubstr("is turned by 90.0 degrees"));
  expect_footprint(import.description, -0.3, 0.3, -0.27, 0.27);

  Import opposite(robot(turned));
  opposite.options.forward = "-y";
  opposite.load();
  expect_wheel(opposite, "left", {0.0, -0.25, -0.05}, 0.1, 0.04);
}

TEST(ImportRobot, TransmissionsCommandInterfacesAndPluginsNameTheMotors) {
  const std::string wheels = wheel("fl", "base_link", "0.2 0.25 -0.05", 0.1, 0.04, "") +
                             wheel("fr", "base_link", "0.2 -0.25 -0.05", 0.1, 0.04, "") +
                             wheel("rl", "base_link", "-0.2 0.25 -0.05", 0.1, 0.04, "") +
                             wheel("rr", "base_link", "-0.2 -0.25 -0.05", 0.1, 0.04, "");
  for (
      const std::string motors :
      {R"(<transmission name="a"><joint name="rl_joint"/></transmission><transmission name="b"><joint name="rr_joint"/></transmission>)",
       R"(<ros2_control name="c" type="system"><joint name="rl_joint"><command_interface name="velocity"/></joint>
           <joint name="rr_joint"><command_interface name="velocity"/></joint><joint name="fl_joint"><state_interface name="velocity"/></joint></ros2_control>)",
       R"(<gazebo><plugin name="drive" filename="libgazebo_ros_diff_drive.so"><left_joint>rl_joint</left_joint><right_joint>rr_joint</right_joint></plugin>
           <plugin name="states" filename="libgazebo_ros_joint_state_publisher.so"><joint_name>fl_joint</joint_name></plugin></gazebo>)"}) {
    Import import(robot(chassis() + wheels + motors));
    import.load();
    EXPECT_TRUE(import.wheel("rl").drive_joint.has_value()) << motors;
    EXPECT_TRUE(import.wheel("rr").drive_joint.has_value()) << motors;
    EXPECT_FALSE(import.wheel("fl").drive_joint.has_value()) << motors;
  }
}

TEST(ImportRobot, ASpinningSensorAboveTheGroundIsNoWheel) {
  const std::string drum = joint("spin", "continuous", "base_link", "drum", "0 0 0.3", axis("0 1 0")) +
                           link("drum", inertial(0.5) + shape("collision", cylinder(0.05, 0.1), "0 0 0", kAcross));
  Import import(robot(chassis() + two_wheels() + caster() + drum));
  EXPECT_EQ(import.load().wheels.size(), 3U);
}

TEST(ImportRobot, AnInertiaOfZeroIsReplacedByThatOfTheShape) {
  std::string text = robot(chassis() + two_wheels() + caster());
  const std::string zero = R"(<inertia ixx="0.01" ixy="0" ixz="0" iyy="0.01" iyz="0" izz="0.01"/>)";
  text.replace(text.find(zero), zero.size(), R"(<inertia ixx="0" ixy="0" ixz="0" iyy="0" iyz="0" izz="0"/>)");
  Import import(text);
  EXPECT_NEAR(import.load().mass_kg, 22.5, 1e-6);
  EXPECT_THAT(import.robot.urdf, HasSubstr(fmt::format("iyy=\"{}\"", 0.005))) << "m r^2 / 2";
  EXPECT_THAT(import.assumptions(), HasSubstr("its inertia of nearly zero is replaced"));
}

TEST(ImportRobot, OurOwnWheeledRobotKeepsItsWheelsAndMass) {
  TemporaryFolder folder;
  RobotImportOptions options{.file = PATROL_SOURCE_DIR "/models/wheeled/wheeled.urdf"};
  options.frames = {{"lidar", "lidar"}, {"imu", "imu"}, {"gnss", "gnss"}};
  const ImportedRobot robot = import_robot(options);
  write_robot(robot, folder / "again");
  const RobotDescription before = io::load_robot_description(options.file.string());
  const RobotDescription after = io::load_robot_description((folder / "again/wheeled.urdf").string());
  EXPECT_NEAR(after.mass_kg, before.mass_kg, 1e-6);
  ASSERT_EQ(after.wheels.size(), before.wheels.size());
  EXPECT_EQ(after.joint_names.size(), before.joint_names.size());
  for (const char* frame : {"lidar", "imu", "gnss"})
    EXPECT_THAT(after.T_body(frame).position, VectorNear(before.T_body(frame).position, 1e-9)) << frame;
  ASSERT_EQ(after.footprint_m.size(), before.footprint_m.size());
  for (std::size_t i = 0; i < after.footprint_m.size(); ++i)
    EXPECT_THAT(after.footprint_m[i], VectorNear(before.footprint_m[i], 1e-6));
}

TEST(ImportRobot, TheResultPassesCheckUrdf) {
  Import import(robot(chassis() + two_wheels() + caster()));
  import.load();
  const std::string command = "check_urdf " + (import.folder / "imported/imported.urdf").string() + " > /dev/null";
  EXPECT_EQ(std::system(command.c_str()), 0);
}

TEST(WriteRobot, RefusesAFolderThatIsNotEmptyAndLeavesNothingBehind) {
  Import import(robot(chassis() + two_wheels() + caster()));
  import.load();
  EXPECT_THROW(write_robot(import.robot, import.folder / "imported"), InputError);
  std::size_t num_entries = 0;
  for (const auto& entry : std::filesystem::directory_iterator(import.folder.path()))
    num_entries += entry.exists() ? 1 : 0;
  EXPECT_EQ(num_entries, 2U) << "the file and the result";
  EXPECT_TRUE(std::filesystem::exists(import.folder / "imported/README.md"));
  EXPECT_TRUE(std::filesystem::exists(import.folder / "imported/imported.yaml"));
  ImportedRobot misnamed = import.robot;
  misnamed.name = "../up";
  EXPECT_THROW(write_robot(misnamed, import.folder / "other"), InputError);
  EXPECT_THROW(write_robot(import.robot, "/proc/nowhere"), InputError);
  ImportedRobot broken = import.robot;
  broken.urdf = "<robot/>";
  EXPECT_THROW(write_robot(broken, import.folder / "other"), InputError);
  EXPECT_FALSE(std::filesystem::exists(import.folder / "other"));
  std::filesystem::create_directory(import.folder / "empty");
  EXPECT_NO_THROW(write_robot(import.robot, import.folder / "empty"));
}

TEST(ImportRobot, AMimicWheelHasAMotorOnlyIfItFollowsAMotor) {
  const auto with_rear = [](const std::string& mimic) {
    return robot(chassis() + two_wheels() + wheel("rl", "base_link", "-0.2 0.25 -0.05", 0.1, 0.04, mimic) +
                 wheel("rr", "base_link", "-0.2 -0.25 -0.05", 0.1, 0.04, mimic) +
                 joint("arm_joint", "revolute", "base_link", "arm", "0 0 0.1",
                       axis("0 1 0") + R"(<limit lower="-1" upper="1"/>)") +
                 link("arm", inertial(0.1)));
  };
  Import driven(with_rear("<mimic joint=\"left_joint\"/>"));
  driven.load();
  EXPECT_THAT(driven.assumptions(), HasSubstr("has a motor: its &lt;mimic> follows a driven wheel, left_joint"));
  EXPECT_TRUE(driven.wheel("rl").drive_joint.has_value());
  Import passive(with_rear("<mimic joint=\"arm_joint\"/>"));
  passive.load();
  EXPECT_THAT(passive.assumptions(), HasSubstr("has no motor: its &lt;mimic> follows arm_joint, which has none"));
  EXPECT_FALSE(passive.wheel("rl").drive_joint.has_value());
}

TEST(ImportRobot, ALinkDenserThanAnyMaterialIsARow) {
  Import import(robot(link("base_link", inertial(19000.0, "0 0 0", 500.0) + shape("collision", box(0.6, 0.4, 0.2))) +
                      two_wheels() + caster()));
  import.load();
  EXPECT_THAT(import.assumptions(),
              HasSubstr("| base_link | 1.9e+04 kg of the file are kept, although its shapes of 0.048 m3 would be of "
                        "395833 kg/m3: more than 25000 kg/m3 are unlikely |"));
  EXPECT_THAT(import.assumptions(), Not(HasSubstr("| left | 1 kg of the file")));
}

TEST(ImportRobot, AChassisWithoutAnyShapeIsARowThatNamesNoVisuals) {
  Import import(robot(link("base_link", inertial(20.0, "0 0 0", 0.5)) + two_wheels() + caster()));
  import.load();
  EXPECT_THAT(import.assumptions(), HasSubstr("| chassis | has neither &lt;collision> nor &lt;visual>: it touches "
                                              "nothing"));
}

// Quadratic searches took 60 s for 6,000 links.
TEST(ImportRobot, AChainOf4000LinksIsReadWithinSeconds) {
  std::string chain, parent = "base_link";
  for (int i = 0; i < 4000; ++i) {
    const std::string name = fmt::format("part_{}", i);
    chain += joint(name + "_joint", i % 2 == 0 ? "fixed" : "revolute", parent, name, "0 0 0.0001",
                   axis("0 1 0") + R"(<limit lower="-1" upper="1"/>)") +
             link(name);
    parent = name;
  }
  const auto start = std::chrono::steady_clock::now();
  Import import(with(chain));
  import_robot(import.options);
  const std::chrono::duration<double> elapsed = std::chrono::steady_clock::now() - start;
  EXPECT_LT(elapsed.count(), 8.0);
}

}  // namespace
}  // namespace patrol::importer::robot_import_test
