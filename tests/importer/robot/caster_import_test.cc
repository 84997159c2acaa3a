#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/wheel_kinematics.h"
#include "tests/importer/robot/description.h"
#include "tests/importer/robot/import.h"

namespace patrol::importer::caster_import_test {
namespace {

using ::testing::HasSubstr, ::testing::Not;

TEST(ImportRobot, AFixedSphereThatTouchesTheGroundBecomesAFreeBallWithoutChangeOfMass) {
  const std::string ball =
      joint("ball_joint", "fixed", "base_link", "ball", "-0.25 0 -0.11") +
      link("ball", inertial(0.1, "0 0 0", 1e-4) + shape("visual", sphere(0.04)) + shape("collision", sphere(0.04)));
  Import import(robot(chassis() + two_wheels() + ball));
  const RobotDescription& robot = import.load();
  ASSERT_EQ(robot.wheels.size(), 3U);
  expect_wheel(import, "ball_ball", {-0.25, 0.0, -0.11}, 0.04, 0.08);
  EXPECT_TRUE(import.wheel("ball_ball").is_caster);
  EXPECT_NEAR(robot.mass_kg, 22.1, 1e-6);
  EXPECT_THAT(import.assumptions(), HasSubstr("| ball | is fixed and touches the ground"));
}

TEST(ImportRobot, ABallOnAJointAboutOneAxisIsAFreeBall) {
  const std::string ball = joint("ball_joint", "continuous", "base_link", "ball", "-0.25 0 -0.11", axis("1 0 0")) +
                           link("ball", inertial(0.8, "0 0 0", 1e-4) + shape("collision", sphere(0.04)));
  Import import(robot(chassis() + two_wheels() + ball));
  const RobotDescription& robot = import.load();
  ASSERT_EQ(robot.wheels.size(), 3U);
  EXPECT_TRUE(import.wheel("ball_ball").is_caster);
  EXPECT_NEAR(robot.mass_kg, 22.8, 1e-6);
}

TEST(ImportRobot, AFixedBoxCasterIsASupportOfARobotWithOneAxle) {
  const std::string skid = joint("skid_joint", "fixed", "base_link", "skid", "-0.2 0 -0.14") +
                           link("skid", inertial(0.005, "0 0 0", 1e-5) + shape("collision", box(0.03, 0.09, 0.02)));
  Import import(robot(chassis() + two_wheels() + skid));
  const RobotDescription& robot = import.load();
  ASSERT_EQ(robot.wheels.size(), 3U);
  expect_wheel(import, "skid_ball", {-0.2, 0.0, -0.125}, 0.025, 0.05);
  EXPECT_NEAR(robot.mass_kg, 22.005, 1e-6);
}

TEST(ImportRobot, ARobotWithOneAxleAndNothingElseGetsASupportWithAnAssumption) {
  Import import(robot(chassis() + two_wheels()));
  const RobotDescription& robot = import.load();
  EXPECT_EQ(robot.wheels.size(), 4U) << "center of mass above the axle: front and rear";
  EXPECT_NEAR(robot.mass_kg, 22.0, 1e-6);
  EXPECT_THAT(import.assumptions(),
              HasSubstr("keeps the robot upright, with 1.5 % of the mass: the file has one axle"));
}

// Files of casters often limit the joint to 180 degrees, because the type revolute needs a range.
TEST(ImportRobot, AJointOfAFullTurnWithoutMotorBelongsToACasterAndWithMotorSteers) {
  const auto with_fork = [](const std::string& limit) {
    std::string text = caster();
    const std::string type = "type=\"continuous\"", axis_z = axis("0 0 1");
    text.replace(text.find(type), type.size(), "type=\"revolute\"");
    text.insert(text.find(axis_z), limit);
    const std::string transmission = R"(<transmission name="t"><joint name="left_joint"/></transmission>
<transmission name="u"><joint name="right_joint"/></transmission>)";
    return robot(chassis() + two_wheels() + text + transmission);
  };
  Import import(with_fork(R"(<limit lower="-3.14" upper="3.14" effort="10" velocity="5"/>)"));
  import.load();
  EXPECT_TRUE(import.wheel("small").is_caster);
  EXPECT_EQ(wheel_drive_type(import.description), WheelDriveType::kDifferential);
  EXPECT_THAT(import.assumptions(), HasSubstr("| swivel | swivels without end, although the file limits it"));
  Import steered(with_fork(R"(<limit lower="-1.5" upper="1.5" effort="10" velocity="5"/>)"));
  EXPECT_FALSE(steered.load().wheels.empty());
  EXPECT_FALSE(steered.wheel("small").is_caster);
}

// A round vacuum cleaner: its chassis ends 5 mm above the ground.
TEST(ImportRobot, AnUprightCylinderOfTheBaseNearTheGroundIsTheChassisAndNoCaster) {
  Import import(
      robot(link("base_link", inertial(20.0, "-0.1 0 0", 0.5) + shape("collision", cylinder(0.2, 0.2), "0 0 -0.045")) +
            two_wheels() + caster()));
  const RobotDescription& robot = import.load();
  ASSERT_EQ(robot.wheels.size(), 3U);
  EXPECT_THAT(import.assumptions(), Not(HasSubstr("is fixed and touches the ground")));
}

TEST(ImportRobot, ACasterThatIsTurnedAtZeroIsAligned) {
  std::string text = caster();
  const std::string origin = R"(<origin xyz="-0.25 0 -0.08" rpy="0 0 0"/>)";
  ASSERT_NE(text.find(origin), std::string::npos);
  text.replace(text.find(origin), origin.size(), R"(<origin xyz="-0.25 0 -0.08" rpy="0 0 1.2"/>)");
  Import import(robot(chassis() + two_wheels() + text));
  import.load();
  expect_wheel(import, "small", {-0.28, 0.0, -0.1}, 0.05, 0.03);
}

}  // namespace
}  // namespace patrol::importer::caster_import_test
