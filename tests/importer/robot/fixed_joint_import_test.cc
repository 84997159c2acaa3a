#include <string>

#include <Eigen/Core>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "importer/robot/normalized_robot.h"
#include "tests/importer/robot/description.h"
#include "tests/importer/robot/import.h"
#include "tests/support/pose_near.h"

namespace patrol::importer::fixed_joint_import_test {
namespace {

using test::VectorNear;
using ::testing::AllOf, ::testing::HasSubstr, ::testing::Not;

TEST(ImportRobot, LinksFixedToAWheelAreMergedByTheParallelAxisTheorem) {
  const Inertial wheel{.mass_kg = 1.0, .inertia = 0.01 * Eigen::Matrix3d::Identity()};
  const Inertial cap{.mass_kg = 1.0, .inertia = 0.02 * Eigen::Matrix3d::Identity()};
  const Inertial both = combine({{Pose3{}, wheel}, {Pose3{.position = {0.0, 0.2, 0.0}}, cap}});
  EXPECT_NEAR(both.mass_kg, 2.0, 1e-12);
  EXPECT_THAT(both.T_link_inertia.position, VectorNear(Eigen::Vector3d(0.0, 0.1, 0.0), 1e-12));
  EXPECT_NEAR(both.inertia(0, 0), 0.03 + 2.0 * 0.01, 1e-12);
  EXPECT_NEAR(both.inertia(1, 1), 0.03, 1e-12);
}

TEST(ImportRobot, NestedFixedJointsAreFlattenedAndMasslessFramesAboveTheBaseAreDropped) {
  const std::string text =
      link("base_footprint") + joint("a", "fixed", "base_footprint", "base_link", "0 0 0.15") + link("base_link") +
      joint("b", "fixed", "base_link", "body", "0.1 0 0") + chassis("body") +
      joint("c", "fixed", "body", "axle", "0 0 -0.05") + link("axle", inertial(2.0)) +
      wheel("left", "axle", "0 0.25 0", 0.1, 0.04) + wheel("right", "axle", "0 -0.25 0", 0.1, 0.04) +
      joint("hub_joint", "fixed", "left", "hub", "0 0.03 0") +
      link("hub", inertial(0.5) + shape("visual", cylinder(0.03, 0.01), "0 0 0", kAcross)) + caster("body");
  Import import(robot(text));
  const RobotDescription& robot = import.load();
  EXPECT_EQ(robot.wheels.size(), 3U);
  expect_wheel(import, "left", {0.0, 0.25, -0.05}, 0.1, 0.04);
  EXPECT_NEAR(robot.mass_kg, 25.0, 1e-6);
  EXPECT_THAT(import.robot.urdf, Not(HasSubstr("base_footprint")));
  EXPECT_THAT(import.assumptions(), HasSubstr("is the link body of the file"));
  EXPECT_TRUE(robot.T_body_sensor.contains("axle"));
}

TEST(ImportRobot, TheBaseLinkOptionSelectsTheFrame) {
  Import import(robot(link("base_footprint") + joint("a", "fixed", "base_footprint", "body", "0 0 0.15") +
                      chassis("body") + two_wheels("body") + caster("body")));
  import.options.base_link = "base_footprint";
  import.load();
  expect_wheel(import, "left", {0.0, 0.25, 0.1}, 0.1, 0.04);
}

TEST(ImportRobot, ArmsAreFixedAtZeroWithTheirMass) {
  const std::string arm = joint("shoulder", "revolute", "base_link", "upper", "0.1 0 0.1",
                                axis("0 1 0") + R"(<limit lower="-1" upper="1" effort="5" velocity="1"/>)") +
                          link("upper", inertial(1.0) + shape("collision", box(0.05, 0.05, 0.3))) +
                          joint("wrist", "continuous", "upper", "hand", "0 0 0.15", axis("0 0 1")) +
                          link("hand", inertial(0.5)) +
                          joint("lift", "prismatic", "base_link", "mast", "0 0 0.1",
                                axis("0 0 1") + R"(<limit lower="0" upper="1" effort="5" velocity="1"/>)") +
                          link("mast", inertial(0.25));
  Import import(robot(chassis() + two_wheels() + caster() + arm));
  const RobotDescription& robot = import.load();
  EXPECT_EQ(robot.wheels.size(), 3U);
  EXPECT_NEAR(robot.mass_kg, 24.25, 1e-6);
  EXPECT_THAT(import.assumptions(), HasSubstr("| shoulder, wrist, lift | fixed at zero"));
  EXPECT_THAT(robot.T_body_sensor.at("hand").position, VectorNear(Eigen::Vector3d(0.1, 0.0, 0.25), 1e-9));
}

TEST(ImportRobot, AFixedJointWhoseLimitsExcludeZeroIsARow) {
  const auto arm = [](const std::string& type, const std::string& limits) {
    return joint("elbow", type, "base_link", "arm", "0.1 0 0.1", axis("0 1 0") + "<limit " + limits + "/>") +
           link("arm", inertial(1.0));
  };
  Import outside(robot(chassis() + two_wheels() + caster() + arm("revolute", R"(lower="0.5" upper="2.5")")));
  outside.load();
  EXPECT_THAT(outside.assumptions(),
              AllOf(HasSubstr("| elbow | zero, at which it is fixed, is outside its limits 0.5 to 2.5 rad |"),
                    HasSubstr("| elbow | fixed at zero")));
  Import below(robot(chassis() + two_wheels() + caster() + arm("prismatic", R"(lower="-0.3" upper="-0.1")")));
  below.load();
  EXPECT_THAT(below.assumptions(), HasSubstr("outside its limits -0.3 to -0.1 m |"));
  Import inside(robot(chassis() + two_wheels() + caster() + arm("revolute", R"(lower="0" upper="2.5")")));
  inside.load();
  EXPECT_THAT(inside.assumptions(), Not(HasSubstr("outside its limits")));
}

TEST(ImportRobot, WithoutWheelsTheMessageNamesAFixedJointWithAMotorAboutAHorizontalAxis) {
  const auto motor = [](const std::string& name) {
    return "<transmission name=\"of_" + name + "\"><joint name=\"" + name + "\"/></transmission>\n";
  };
  Import import(robot(chassis() + motor("swivel") + motor("roll") +
                      joint("swivel", "fixed", "base_link", "fork", "0.2 0 -0.1", axis("0 0 1")) + link("fork") +
                      joint("roll", "fixed", "fork", "rear", "0 0 0", axis("0 1 0")) +
                      link("rear", inertial(1.0) + shape("collision", box(0.1, 0.1, 0.1))) +
                      joint("wrist", "continuous", "base_link", "hand", "0.3 0 0.4", axis("1 0 0")) +
                      link("hand", inertial(0.1) + shape("collision", box(0.1, 0.2, 0.1)))));
  EXPECT_THAT(complaint(import), HasSubstr(": roll: has a motor, but is fixed); no legs either"));
}

TEST(ImportRobot, AWheelOnASuspensionIsFixedToTheChassis) {
  const std::string suspended = joint("spring", "prismatic", "base_link", "arm", "0 0.25 -0.05",
                                      axis("0 0 1") + R"(<limit lower="-0.1" upper="0.1" effort="5" velocity="1"/>)") +
                                link("arm", inertial(0.5)) + wheel("left", "arm", "0 0 0", 0.1, 0.04) +
                                wheel("right", "base_link", "0 -0.25 -0.05", 0.1, 0.04) + caster();
  Import import(robot(chassis() + suspended));
  import.load();
  expect_wheel(import, "left", {0.0, 0.25, -0.05}, 0.1, 0.04);
  EXPECT_THAT(import.assumptions(), HasSubstr("| spring | fixed at zero"));
}

}  // namespace
}  // namespace patrol::importer::fixed_joint_import_test
