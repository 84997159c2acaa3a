#include <array>
#include <cmath>
#include <cstddef>
#include <regex>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/error.h"
#include "core/leg_kinematics.h"
#include "core/random.h"
#include "tests/importer/robot/description.h"
#include "tests/importer/robot/import.h"
#include "tests/support/legged_urdf.h"
#include "tests/support/pose_near.h"

namespace patrol::importer {
namespace {

using test::UrdfQuadruped;
using test::VectorNear;
using testing::HasSubstr;
using testing::Not;

/// Replaces every `old`.
std::string replaced(std::string text, const std::string& old, const std::string& by) {
  for (std::size_t at = text.find(old); at != std::string::npos; at = text.find(old, at + by.size()))
    text.replace(at, old.size(), by);
  return text;
}

UrdfQuadruped vendor_robot() { return {.frames = test::actuator_frames()}; }

/// Feet without spheres: a box around the end of each shank.
std::string without_spheres(const UrdfQuadruped& robot) {
  return replaced(robot.text(), "<sphere radius=\"0.022\"/>", "<box size=\"0.044 0.044 0.044\"/>");
}

RobotDescription described(const UrdfQuadruped& robot) {
  return io::load_robot_description(test::TemporaryFile("direct.urdf", robot.text()).path());
}

void expect_same_legs(const RobotDescription& robot, const RobotDescription& expected, double tolerance_m) {
  ASSERT_EQ(robot.legs.size(), 4U);
  EXPECT_NEAR(robot.mass_kg, expected.mass_kg, 1e-5);
  const RandomStream stream(1, "test/import/legs");
  for (std::size_t leg = 0; leg < 4; ++leg) {
    EXPECT_EQ(robot.legs[leg].name, expected.legs[leg].name);
    for (std::uint64_t i = 0; i < 20; ++i) {
      Eigen::Vector3d angles;
      for (int k = 0; k < 3; ++k) {
        const auto joint = 3 * leg + static_cast<std::size_t>(k);
        EXPECT_EQ(robot.joint_names[joint], expected.joint_names[joint]);
        const JointLimit &limit = robot.joint_limits[joint], &given = expected.joint_limits[joint];
        EXPECT_NEAR(limit.lower_rad, given.lower_rad, 1e-6);
        EXPECT_NEAR(limit.effort_nm, given.effort_nm, 1e-6);
        angles[k] =
            limit.lower_rad + (limit.upper_rad - limit.lower_rad) * stream.uniform(i, static_cast<std::uint64_t>(k));
      }
      EXPECT_THAT(foot_position(robot.legs[leg], angles),
                  VectorNear(foot_position(expected.legs[leg], angles), tolerance_m));
    }
  }
}

TEST(LeggedImport, KeepsNamesAnglesAndLimitsAndMovesTheFeetAsTheFileWithin1Micrometer) {
  Import import(vendor_robot().text());
  expect_same_legs(import.load(), described(vendor_robot()), 1e-6);
  EXPECT_THAT(import.robot.settings, HasSubstr("odometry_source: legged"));
  EXPECT_THAT(import.assumptions(), HasSubstr("scaled to 20 kg and legs of 0.45 m"));
}

TEST(LeggedImport, AFootWithoutASphereBecomesABallInTheEndOfTheLegWithin1Centimeter) {
  Import import(without_spheres(vendor_robot()));
  expect_same_legs(import.load(), described(vendor_robot()), 0.015);
  for (const LegGeometry& leg : import.description.legs) {
    EXPECT_GT(leg.foot_radius_m, 0.02);
    EXPECT_LT(leg.foot_radius_m, 0.035);
  }
  EXPECT_THAT(import.assumptions(), HasSubstr("its foot is a ball of radius"));
}

int num_cylinders(const Import& import) {
  int count = 0;
  const std::string text = import.robot.urdf;
  for (std::size_t at = text.find("<cylinder"); at != std::string::npos; at = text.find("<cylinder", at + 1)) ++count;
  return count;
}

TEST(LeggedImport, AShankThatReachesToTheEndOfItsFootIsReplacedByACylinderAndAShorterOneStays) {
  UrdfQuadruped robot = vendor_robot();
  Import plain(robot.text());
  plain.load();
  EXPECT_EQ(num_cylinders(plain), 0);
  robot.shank_collision_ratio = 1.27;  // 0.246 m below the knee; the foot ends at 0.252 m
  Import import(robot.text());
  expect_same_legs(import.load(), described(robot), 1e-6);
  EXPECT_EQ(num_cylinders(import), 4);
  EXPECT_THAT(import.assumptions(), HasSubstr("replaced by a cylinder that ends before it"));
}

TEST(LeggedImport, AMarkerOfTheWorldAboveAFloatingJointIsLeftOut) {
  std::string text = replaced(vendor_robot().text(), "base_link", "trunk");
  text = replaced(text, "<link name=\"trunk\">",
                  "<link name=\"base_link\"><visual><geometry><box size=\"0.01 0.01 0.01\"/></geometry></visual></link>"
                  "<joint name=\"floating_base\" type=\"floating\"><parent link=\"base_link\"/><child "
                  "link=\"trunk\"/></joint><link name=\"trunk\">");
  Import import(text);
  expect_same_legs(import.load(), described(vendor_robot()), 1e-6);
  EXPECT_THAT(import.assumptions(), HasSubstr("| base_link | its visuals are left out: they mark the world above the "
                                              "floating joint floating_base |"));
}

TEST(LeggedImport, LegsThatCannotBeSimulatedAreNamedByALinkAndALineOfTheFile) {
  UrdfQuadruped robot = vendor_robot();
  robot.frames = {};
  Import import(replaced(robot.text(), "<axis xyz=\"1.000000000000 0.000000000000 0.000000000000\"/>",
                         "<axis xyz=\"0.6 0 0.8\"/>"));
  const std::string message = complaint(import);
  EXPECT_THAT(message, testing::MatchesRegex("vendor.urdf:[0-9]+: [a-z]+_2: the robot cannot be simulated: .*"));
}

TEST(LeggedImport, ARobotThatWalksAlongYOfTheFileIsTurned) {
  const std::string text = replaced(vendor_robot().text(), "base_link", "trunk");
  const std::string turned =
      replaced(text, "<link name=\"trunk\">",
               "<link name=\"top\"/><joint name=\"mount\" type=\"fixed\"><parent link=\"top\"/><child "
               "link=\"trunk\"/><origin xyz=\"0 0 0\" rpy=\"0 0 1.5707963267949\"/></joint><link name=\"trunk\">");
  Import import(turned);
  import.options.base_link = "top";
  expect_same_legs(import.load(), described(vendor_robot()), 1e-6);
  EXPECT_THAT(import.assumptions(), HasSubstr("is turned by 90 degrees: the knees turn about y"));
}

TEST(LeggedImport, ABaseAtTheTailIsMovedToTheMiddleOfTheLegs) {
  std::string text = replaced(vendor_robot().text(), "base_link", "trunk");
  text = replaced(text, "<link name=\"trunk\">",
                  "<link name=\"tail\"/><joint name=\"mount\" type=\"fixed\"><parent link=\"tail\"/><child "
                  "link=\"trunk\"/><origin xyz=\"0.4 0 0.05\"/></joint><link name=\"trunk\">");
  Import import(text);
  import.options.base_link = "tail";
  expect_same_legs(import.load(), described(vendor_robot()), 1e-6);
  EXPECT_THAT(import.assumptions(), HasSubstr("is moved by 0.400, 0.000, 0.050 m to the middle"));
}

TEST(LeggedImport, AMassOutsideOfTheTestedRangeIsARow) {
  for (const double mass_kg : {5.0, 13.0, 86.8}) {
    UrdfQuadruped robot = vendor_robot();
    robot.mass_kg = mass_kg;
    Import import(robot.text());
    import.load();
    const auto has_row = HasSubstr("are outside of the tested range of robots with legs, 6 to 60 kg");
    if (mass_kg == 13.0) EXPECT_THAT(import.assumptions(), Not(has_row));
    else EXPECT_THAT(import.assumptions(), has_row) << mass_kg;
  }
}

TEST(LeggedImport, AnArmOnTheBackIsFixedAndReported) {
  std::string arm;
  std::string parent = "base_link";
  for (int i = 0; i < 5; ++i) {
    const std::string name = "arm_" + std::to_string(i);
    arm += joint(name + "_joint", "revolute", parent, name, "0 0 0.1",
                 axis("0 1 0") + R"(<limit lower="-1" upper="1" effort="5" velocity="2"/>)") +
           link(name, inertial(0.4));
    parent = name;
  }
  Import import(replaced(vendor_robot().text(), "</robot>", arm + "</robot>"));
  EXPECT_EQ(import.load().joint_names.size(), 12U);
  EXPECT_NEAR(import.description.mass_kg, described(vendor_robot()).mass_kg + 5 * 0.4, 1e-5);
  EXPECT_THAT(import.assumptions(), HasSubstr("fixed at zero: not joints of wheels or legs"));
}

/// Adds a gimbal of three revolute joints with the given axes.
std::string with_gimbal(const std::string& text, const std::array<std::string, 3>& axes) {
  std::string gimbal;
  for (std::size_t i = 0; i < 3; ++i) {
    const std::string name = "gimbal_" + std::to_string(i);
    gimbal += joint(name + "_joint", "revolute", i == 0 ? "base_link" : "gimbal_" + std::to_string(i - 1), name,
                    "0 0 0.05", axis(axes[i]) + R"(<limit lower="-1" upper="1" effort="2" velocity="2"/>)") +
              link(name, inertial(0.1) + shape("collision", box(0.05, 0.05, 0.05)));
  }
  return replaced(text, "</robot>", gimbal + "</robot>");
}

TEST(LeggedImport, AGimbalOfThreeJointsIsFixedAndReported) {
  const UrdfQuadruped vendor = vendor_robot();
  Import import(with_gimbal(vendor.text(), {"0 0 1", "1 0 0", "0 1 0"}));
  const RobotDescription& robot = import.load();
  EXPECT_EQ(robot.legs.size(), 4U);
  EXPECT_EQ(robot.joint_names, described(vendor).joint_names);
  EXPECT_THAT(import.assumptions(), HasSubstr("gimbal_0_joint, gimbal_1_joint, gimbal_2_joint | fixed at zero"));
}

TEST(LeggedImport, APlanarJointAboveTheTrunkIsNoJointOfALeg) {
  Import import(
      replaced(vendor_robot().text(), "</robot>",
               link("plane") + joint("place", "planar", "plane", "base_link", "0 0 0", axis("0 0 1")) + "</robot>"));
  EXPECT_EQ(import.load().legs.size(), 4U);
  EXPECT_THAT(import.assumptions(), HasSubstr("| place | fixed at zero"));
}

// Three joints in a row that are all about the vertical are no leg that can walk.
TEST(LeggedImport, ARobotThatCannotBeSimulatedIsRefusedByALineOfItsFileAndNoneOfTheFileThatIsNotWritten) {
  const UrdfQuadruped plain;
  Import import(std::regex_replace(plain.text(), std::regex("<axis xyz=\"[^\"]*\"/>"), axis("0 0 1")));
  try {
    import.load();
    ADD_FAILURE();
  } catch (const InputError& error) {
    EXPECT_THAT(error.what(), testing::StartsWith(import.options.file.string() + ":"));
    EXPECT_THAT(error.what(),
                testing::MatchesRegex(".*vendor.urdf:[0-9]+: [a-z]+_2: the robot cannot be simulated: .*"));
    EXPECT_THAT(error.what(), Not(HasSubstr("imported.urdf")));
  }
}

TEST(LeggedImport, JointsWithoutLimitsGetTorqueSpeedAndAHalfTurnAndAreReported) {
  UrdfQuadruped robot = vendor_robot();
  std::string text = replaced(robot.text(), " effort=\"40\" velocity=\"25\"", "");
  Import import(text);
  import.load();
  EXPECT_NEAR(import.description.joint_limits[0].effort_nm, 0.42 * 20.0 * 9.81 * 0.45, 0.5);
  EXPECT_NEAR(import.description.joint_limits[0].velocity_radps, 20.0, 1e-6);
  EXPECT_NEAR(import.description.joint_limits[2].effort_nm, 60.0, 1e-6);
  EXPECT_THAT(import.assumptions(), HasSubstr("of weight times length of the leg"));
}

TEST(LeggedImport, LinksOfLegsWithoutInertiaCountWithTheirAssumedMass) {
  const std::regex inertia_of_thighs("(<link name=\"[a-z]+_1\">)<inertial>.*?</inertial>");
  Import import(std::regex_replace(vendor_robot().text(), inertia_of_thighs, "$1"));
  const double mass_kg = import.load().mass_kg;
  EXPECT_THAT(import.assumptions(), HasSubstr("kg is assumed, 500 kg/m3 in its shape"));
  EXPECT_THAT(import.assumptions(), HasSubstr(fmt::format("scaled to {:.3g} kg", mass_kg)));
}

TEST(LeggedImport, ATorqueLimitThatIsAPlaceholderIsARow) {
  Import plain(vendor_robot().text());
  plain.load();
  EXPECT_THAT(plain.assumptions(), Not(HasSubstr("is kept")));
  Import import(std::regex_replace(vendor_robot().text(), std::regex("effort=\"[0-9.]+\""), "effort=\"1000\""));
  import.load();
  // 0.42 * 20 kg * 9.81 m/s2 * 0.45 m = 37 N m.
  EXPECT_THAT(import.assumptions(), HasSubstr("torque limit 1000 N m of the file is kept: 27 times that of walking"));
}

TEST(LeggedImport, LinksNamedFootHeadOrWheelDecideNothing) {
  UrdfQuadruped robot;
  robot.legs = {"left_wheel", "imu_foot", "head", "arm"};
  Import import(robot.text());
  EXPECT_EQ(import.load().legs.size(), 4U);
  EXPECT_TRUE(import.description.wheels.empty());
}

TEST(LeggedImport, TheOptionLegsOnARobotWithWheelsIsRefusedWithOneLine) {
  Import import(robot(chassis() + two_wheels() + caster()));
  import.options.drive = "legs";
  try {
    import.load();
    FAIL() << "accepted";
  } catch (const InputError& error) {
    EXPECT_THAT(error.what(), HasSubstr("drive legs: the robot must have four legs of three revolute joints each"));
    EXPECT_THAT(error.what(), Not(HasSubstr("\n")));
  }
}

}  // namespace
}  // namespace patrol::importer
