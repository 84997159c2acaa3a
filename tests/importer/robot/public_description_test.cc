#include <string>
#include <utility>

#include <Eigen/Core>
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/wheel_kinematics.h"
#include "tests/importer/robot/description.h"
#include "tests/importer/robot/import.h"
#include "tests/support/pose_near.h"
#include "tests/support/simulated_wheeled_robot.h"

/// Synthetic descriptions with the faults and habits of public ones: imported with an assumption, or refused with a
/// hint.
namespace patrol::importer::public_description_test {
namespace {

using ::testing::AllOf, ::testing::HasSubstr, ::testing::MatchesRegex, ::testing::Not;

/// A passive wheel that rolls about y behind the driven axle and cannot swivel.
std::string small_wheel(const std::string& name, double y_m, double radius_m, const std::string& limit = "") {
  return wheel(name, "base_link", fmt::format("-0.25 {} {}", y_m, radius_m - 0.15), radius_m, 0.03, limit);
}

TEST(PublicDescription, ASmallWheelThatCannotSwivelIsACaster) {
  Import import(robot(chassis() + two_wheels() + small_wheel("a", 0.2, 0.06) + small_wheel("b", -0.2, 0.06)));
  const RobotDescription& robot = import.load();
  ASSERT_EQ(robot.wheels.size(), 4U);
  EXPECT_TRUE(import.wheel("a_ball").is_caster);
  EXPECT_TRUE(import.wheel("b_ball").is_caster);
  EXPECT_THAT(import.wheel("a_ball").center_in_body, test::VectorNear(Eigen::Vector3d(-0.25, 0.2, -0.09), 1e-6));
  EXPECT_NEAR(robot.mass_kg, 24.0, 1e-6);
  EXPECT_THAT(import.assumptions(), AllOf(HasSubstr("| a_joint, b_joint | is a caster: its wheel is smaller"),
                                          Not(HasSubstr("fixed at zero"))));
}

TEST(PublicDescription, WheelsThatMayKeepTheRobotFromTurningStay) {
  Import equal(robot(chassis() + two_wheels() + small_wheel("a", 0.25, 0.1) + small_wheel("b", -0.25, 0.1)));
  equal.load();
  EXPECT_FALSE(equal.wheel("a").is_caster) << "as large as the driven wheels: skid steering";
  Import driven(
      robot(chassis() + two_wheels() + small_wheel("a", 0.2, 0.06, kMotor) + small_wheel("b", -0.2, 0.06, kMotor)));
  driven.load();
  EXPECT_TRUE(driven.wheel("a").drive_joint.has_value());
}

std::string fixed_wheel(const std::string& name, const std::string& xyz, const std::string& parent = "base_link") {
  return joint(name + "_joint", "fixed", parent, name, xyz) +
         link(name, inertial(1.0) + shape("collision", cylinder(0.1, 0.05), "0 0 0", kAcross));
}

std::string four_fixed_wheels(const std::string& parent = "base_link") {
  return fixed_wheel("fl", "0.2 0.25 -0.05", parent) + fixed_wheel("fr", "0.2 -0.25 -0.05", parent) +
         fixed_wheel("rl", "-0.2 0.25 -0.05", parent) + fixed_wheel("rr", "-0.2 -0.25 -0.05", parent);
}

TEST(PublicDescription, FixedWheelsTurnIfNoOthersDo) {
  Import import(robot(chassis() + four_fixed_wheels()));
  const RobotDescription& robot = import.load();
  EXPECT_EQ(robot.wheels.size(), 4U);
  EXPECT_EQ(wheel_drive_type(robot), WheelDriveType::kDifferential);
  EXPECT_THAT(import.assumptions(), HasSubstr("| drive | skid steering: the file has no rollers"));
  EXPECT_THAT(import.assumptions(), HasSubstr("| fl_joint, fr_joint, rl_joint, rr_joint | turns, although the file "
                                              "fixes it"));
}

TEST(PublicDescription, OtherFixedCylindersStayFixed) {
  Import one(robot(chassis() + fixed_wheel("roller", "0.2 0 -0.05")));
  EXPECT_THAT(complaint(one), HasSubstr("no wheels found")) << "no partner across from it";
  Import legged(robot(chassis() +
                      joint("hip", "revolute", "base_link", "thigh", "0 0.2 0",
                            axis("0 1 0") + R"(<limit lower="-1" upper="1" effort="5" velocity="1"/>)") +
                      link("thigh", inertial(1.0)) + fixed_wheel("l", "0 0 -0.3", "thigh") +
                      fixed_wheel("r", "0 -0.4 -0.3", "thigh")));
  EXPECT_THAT(complaint(legged), HasSubstr("no wheels found")) << "on a leg";
  Import both(robot(chassis() + two_wheels() + caster() + fixed_wheel("x", "0.2 0.25 -0.05") +
                    fixed_wheel("y", "0.2 -0.25 -0.05")));
  both.load();
  EXPECT_THAT(both.assumptions(), Not(HasSubstr("although the file fixes it"))) << "other wheels turn";
}

TEST(PublicDescription, JointsThatMoveTheRobotInTheWorldAreNoCasters) {
  const std::string limit = R"(<limit lower="-10" upper="10" effort="1" velocity="1"/>)";
  const std::string planar =
      link("world") + joint("x", "prismatic", "world", "along", "0 0 0", axis("1 0 0") + limit) + link("along") +
      joint("y", "prismatic", "along", "across", "0 0 0", axis("0 1 0") + limit) + link("across") +
      joint("yaw", "continuous", "across", "base_link", "0 0 0.05", axis("0 0 1"));
  Import import(robot(planar + chassis() + four_fixed_wheels()));
  EXPECT_EQ(import.load().wheels.size(), 4U);
  EXPECT_THAT(import.assumptions(), HasSubstr("| x, y, yaw | fixed at zero"));
  Import one_axle(robot(planar + chassis() + two_wheels()));
  EXPECT_EQ(one_axle.load().wheels.size(), 4U) << "with two balls that keep it upright";
  EXPECT_THAT(one_axle.assumptions(), HasSubstr("| x, y, yaw | fixed at zero"));
}

// Exporters of CAD programs write these limits for every joint without a range.
TEST(PublicDescription, AJointWithBothLimitsAtZeroIsFixed) {
  Import import(robot(chassis() + two_wheels() + caster() +
                      joint("mast_joint", "revolute", "base_link", "mast", "0 0 0.2",
                            axis("0 0 1") + R"(<limit lower="0" upper="0" effort="0" velocity="0"/>)") +
                      link("mast", inertial(0.5))));
  EXPECT_EQ(import.load().wheels.size(), 3U);
  EXPECT_THAT(import.assumptions(), HasSubstr("| mast_joint | fixed at zero: its limits lower and upper are both 0"));
}

// A robot of 1.5 kg. With a deflection of 2 % of the radius, the balls would be too stiff for the time step.
TEST(PublicDescription, ASmallRobotWithBallCastersOf5MillimetersStandsFor3SecondsWithATiltBelow1Degree) {
  std::string text = link("base_link", inertial(1.4, "-0.05 0 0.02", 0.009) +
                                           shape("collision", box(0.266, 0.266, 0.094), "-0.064 0 0.047"));
  for (const auto& [name, y] : {std::pair{"left", "0.144"}, {"right", "-0.144"}}) {
    text += joint(std::string(name) + "_joint", "continuous", "base_link", name, fmt::format("0 {} 0.023", y),
                  axis("0 1 0")) +
            link(name, inertial(0.03, "0 0 0", 1.5e-5) + shape("collision", cylinder(0.033, 0.018), "0 0 0", kAcross));
  }
  for (const auto& [name, y] : {std::pair{"ball_l", "0.064"}, {"ball_r", "-0.064"}}) {
    text += joint(std::string(name) + "_joint", "fixed", "base_link", name, fmt::format("-0.177 {} -0.005", y)) +
            link(name, inertial(0.005, "0 0 0", 1e-6) + shape("collision", sphere(0.005)));
  }
  Import import(robot(text));
  ASSERT_EQ(import.load().wheels.size(), 4U);
  const std::string level = R"(<mujoco><option timestep="0.002" cone="elliptic"/><worldbody>
    <geom name="ground" type="plane" size="20 20 1" contype="1" conaffinity="2"/></worldbody></mujoco>)";
  sim::WheeledRobot standing(level, import.robot.urdf);
  EXPECT_LT(standing.drive(0.0, 0.0, 3.0).max_tilt_rad, 0.0175);
}

TEST(PublicDescription, ABaseBelowTheGroundIsMovedUp) {
  Import import(
      robot(link("low") + joint("j", "fixed", "low", "base_link", "0 0 0.2") + chassis() + two_wheels() + caster()));
  import.options.base_link = "low";
  EXPECT_NEAR(import.load().body_height_m(), 0.0, 1e-9);
  EXPECT_NEAR(import.wheel("left").center_in_body.z(), 0.1, 1e-6);
  EXPECT_THAT(import.assumptions(), HasSubstr("| base_link | is moved up by 0.050 m: it was below the ground"));
}

/// Two driven wheels with losses, and a caster. Each driven wheel of 0.1 m holds 8.71 N m by friction 0.8.
std::string with_losses(const std::string& motor, double damping) {
  const std::string content = motor + fmt::format(R"(<dynamics damping="{}" friction="0.5"/>)", damping);
  return robot(chassis() + wheel("left", "base_link", "0 0.25 -0.05", 0.1, 0.04, content) +
               wheel("right", "base_link", "0 -0.25 -0.05", 0.1, 0.04, content) + caster());
}

TEST(PublicDescription, DampingThatTheMotorCannotOvercomeIsReduced) {
  const std::string motor = R"(<limit effort="5" velocity="12"/>)";
  Import import(with_losses(motor, 1.0));
  import.load();
  EXPECT_THAT(import.assumptions(),
              HasSubstr("| left_joint, right_joint | damping and friction take 12.5 N m at 12 "
                        "rad/s, more than the torque limit of 5 N m: reduced to a quarter of it"));
  EXPECT_THAT(import.robot.urdf, HasSubstr(R"(<dynamics damping="0.1" friction="0.05"/>)"));
  Import light(with_losses(motor, 0.3));
  light.load();
  EXPECT_THAT(light.robot.urdf, HasSubstr(R"(<dynamics damping="0.3" friction="0.5"/>)"));
}

// Published descriptions have 1e4 N m and 1000 rad/s for unknown limits, and damping for simulators that set the speed.
TEST(PublicDescription, DampingThatBrakesMoreThanTheTiresHoldIsReducedWhateverTheMotor) {
  const std::string motor = R"(<limit effort="10000" velocity="1000"/>)";
  Import import(with_losses(motor, 1.0));
  import.load();
  EXPECT_THAT(import.assumptions(), HasSubstr("| left_joint, right_joint | damping and friction take 15.5 N m at 15 "
                                              "rad/s, more than the friction of the tire of 8.71 N m: reduced"));
  Import light(with_losses(motor, 0.5));
  light.load();
  EXPECT_THAT(light.robot.urdf, HasSubstr(R"(<dynamics damping="0.5" friction="0.5"/>)"));
}

TEST(PublicDescription, AMissingSpeedLimitIsLowerForSmallWheels) {
  const auto assumptions_with = [](const std::string& z, double radius_m) {
    Import import(robot(chassis() + wheel("left", "base_link", "0 0.25 " + z, radius_m, 0.04, "") +
                        wheel("right", "base_link", "0 -0.25 " + z, radius_m, 0.04, "") + caster()));
    import.load();
    return import.assumptions();
  };
  EXPECT_THAT(assumptions_with("-0.1", 0.05), HasSubstr("speed limit 21.2 rad/s: 1.1 m/s"));
  EXPECT_THAT(assumptions_with("-0.05", 0.1), HasSubstr("speed limit 15 rad/s: 1.5 m/s"));
  EXPECT_THAT(assumptions_with("0.05", 0.2), HasSubstr("speed limit 7.5 rad/s: 1.5 m/s"));
}

TEST(PublicDescription, ASpeedLimitThatNoRobotReachesIsTakenForAMissingOne) {
  const auto import_with = [](const std::string& velocity) {
    const std::string motor = R"(<limit effort="5" velocity=")" + velocity + R"("/>)";
    Import import(robot(chassis() + wheel("left", "base_link", "0 0.25 -0.1", 0.05, 0.04, motor) +
                        wheel("right", "base_link", "0 -0.25 -0.1", 0.05, 0.04, motor) + caster()));
    import.load();
    return std::pair{import.assumptions(), import.robot.settings};
  };
  const auto [assumed, settings] = import_with("1000");  // 50 m/s
  EXPECT_THAT(
      assumed,
      HasSubstr("| left_joint, right_joint | speed limit 1000 rad/s of the file, 50 m/s, is kept for the motor; "
                "the robot drives at 1.1 m/s | wheel_drive.max_speed_mps |"));
  EXPECT_THAT(settings, HasSubstr("wheel_drive: {max_speed_mps: 1.06}"));
  const auto [fast_assumed, fast_settings] = import_with("200");  // 10 m/s, less than ten times the assumed 1.06 m/s
  EXPECT_THAT(fast_assumed, Not(HasSubstr("is kept for the motor")));
  EXPECT_THAT(fast_settings, HasSubstr("wheel_drive: {max_speed_mps: 1.50}"));
}

TEST(PublicDescription, AChassisThatHitsARampBeforeTheWheelsDoIsReported) {
  const auto with_overhang = [](double length_m) {
    return robot(link("base_link", inertial(20.0, "-0.1 0 0", 0.5) + shape("collision", box(length_m, 0.4, 0.24))) +
                 two_wheels() + caster());
  };
  Import import(with_overhang(0.8));
  import.load();
  // The corner is 0.4 m ahead of the axle and 0.07 m below it: asin(0.1 / hypot) - atan(0.07 / 0.4) = 4.3 degrees.
  EXPECT_THAT(import.assumptions(),
              HasSubstr("| base_link | its collision shape reaches 0.40 m ahead of the axle, 0.030 "
                        "m above the ground: it hits ramps steeper than 4.3 degrees |"));
  Import compact(with_overhang(0.3));
  compact.load();
  EXPECT_THAT(compact.assumptions(), Not(HasSubstr("ahead of the axle")));
}

TEST(PublicDescription, ARobotWithTwoWheelsInARowOfGearsKeepsItsWheels) {
  std::string gears =
      joint("ring", "continuous", "base_link", "ring", "0 0.1 -0.02", axis("0 1 0")) +
      link("ring", inertial(0.1, "0 0 0", 1e-4) + shape("collision", cylinder(0.03, 0.02), "0 0 0", kAcross));
  for (int i = 0; i < 4; ++i) {
    const std::string name = fmt::format("pinion{}", i);
    gears +=
        joint(name, "continuous", "ring", name, fmt::format("{} 0 0", i < 2 ? 0.01 : -0.01), axis("1 0 0")) +
        link(name, inertial(0.01, "0 0 0", 1e-5) + shape("collision", cylinder(0.005, 0.01), "0 0 0", "0 1.5708 0"));
  }
  Import import(with(gears));
  EXPECT_EQ(import.load().wheels.size(), 3U) << "pinions across the axle are no rollers of a mecanum wheel";
}

TEST(PublicDescription, ALeggedRobotThatLiesIsRefusedWithTheJointThatTurnsIt) {
  std::string text = link("trunk", inertial(10.0, "0 0 0", 0.3) + shape("collision", box(0.5, 0.1, 0.2)));
  const std::string limit = R"(<limit lower="-2" upper="2" effort="20" velocity="20"/>)";
  for (const auto& [leg, xyz] :
       {std::pair{"fl", "0.2 0 0.1"}, {"fr", "0.2 0 -0.1"}, {"rl", "-0.2 0 0.1"}, {"rr", "-0.2 0 -0.1"}}) {
    const std::string name = leg;
    text += joint(name + "_hip", "revolute", "trunk", name + "_a", xyz, axis("1 0 0") + limit) +
            link(name + "_a", inertial(0.5)) +
            joint(name + "_thigh", "revolute", name + "_a", name + "_b", "0 0 0.05", axis("0 0 1") + limit) +
            link(name + "_b", inertial(0.5)) +
            joint(name + "_knee", "revolute", name + "_b", name + "_c", "0 -0.2 0", axis("0 0 1") + limit) +
            link(name + "_c", inertial(0.2) + shape("collision", sphere(0.02), "0 -0.2 0"));
  }
  Import import(robot(text));
  EXPECT_THAT(
      complaint(import),
      MatchesRegex("vendor.urdf:[0-9]+: fl_hip: the first joints of the legs are 0.20 m apart in height, but only "
                   "0.00 m to the side: z of trunk must be up: add a root link with a fixed joint that turns the "
                   "robot"));
}

}  // namespace
}  // namespace patrol::importer::public_description_test
