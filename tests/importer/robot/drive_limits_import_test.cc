#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/importer/robot/description.h"
#include "tests/importer/robot/import.h"

namespace patrol::importer::drive_limits_import_test {
namespace {

using ::testing::AllOf, ::testing::HasSubstr, ::testing::MatchesRegex, ::testing::Not;

/// Two wheels of 0.1 m radius with a <limit>, on a chassis with a caster, and more.
std::string with_limit(const std::string& limit, const std::string& more = "") {
  return robot(chassis() + wheel("left", "base_link", "0 0.25 -0.05", 0.1, 0.04, limit) +
               wheel("right", "base_link", "0 -0.25 -0.05", 0.1, 0.04, limit) + caster() + more);
}

/// Velocity interfaces of both wheels with these bounds.
std::string interfaces(const std::string& min, const std::string& max) {
  std::string text = "<ros2_control name=\"c\" type=\"system\">";
  for (const char* side : {"left", "right"})
    text += fmt::format(R"(<joint name="{}_joint"><command_interface name="velocity"><param name="min">{}</param>)"
                        R"(<param name="max">{}</param></command_interface></joint>)",
                        side, min, max);
  return text + "</ros2_control>\n";
}

TEST(DriveLimits, TheSpeedLimitOfACommandInterfaceIsUsedIfItIsTheOnlyOneOrTheLowerOne) {
  const std::vector<std::pair<const char*, const char*>> cases = {
      {"", ""}, {R"(<limit effort="10" velocity="12"/>)", ", instead of the 12 rad/s of &lt;limit>"}};
  for (const auto& [limit, discarded] : cases) {
    Import import(with_limit(limit, interfaces("-4", "5")));
    import.load();
    EXPECT_THAT(import.robot.settings, HasSubstr("wheel_drive: {max_speed_mps: 0.50}"));
    EXPECT_THAT(
        import.assumptions(),
        AllOf(HasSubstr(fmt::format(
                  "| left_joint, right_joint | speed limit 5 rad/s is that of its command interface{} |", discarded)),
              Not(HasSubstr("<limit velocity> of the joint"))));
  }
  Import higher(with_limit(kMotor, interfaces("-40", "40")));
  higher.load();
  EXPECT_THAT(higher.robot.settings, HasSubstr("max_speed_mps: 1.20"));
  EXPECT_THAT(higher.assumptions(), Not(HasSubstr("command interface")));
  Import broken(with_limit(kMotor, interfaces("-4", "fast")));
  EXPECT_THAT(complaint(broken),
              MatchesRegex("vendor.urdf:[0-9]+: left_joint: max = \"fast\" of its command interface: "
                           "must be a number"));
}

TEST(DriveLimits, ASpeedLimitBelowAFifthOfTheUsualSpeedIsARowWithBothSpeeds) {
  const auto rows_of = [](double limit_radps) {
    Import import(with_limit(fmt::format(R"(<limit effort="10" velocity="{}"/>)", limit_radps)));
    import.load();
    return import.assumptions();
  };
  EXPECT_THAT(rows_of(2.9),
              HasSubstr("speed limit 2.9 rad/s of the file is 0.29 m/s: slow, a robot of its size without "
                        "a limit drives at 1.5 m/s"));
  EXPECT_THAT(rows_of(3.1), Not(HasSubstr("slow, a robot")));
}

TEST(DriveLimits, MotorsFasterThanTheSpeedOfTheSettingsAreARow) {
  Import fast(with_limit(R"(<limit effort="10" velocity="21.3"/>)"));
  fast.load();
  EXPECT_THAT(fast.robot.settings, HasSubstr("wheel_drive: {max_speed_mps: 1.50}"));
  EXPECT_THAT(fast.assumptions(),
              HasSubstr("| speed | drives at up to 1.5 m/s, although the motors reach 2.13 m/s | "
                        "wheel_drive.max_speed_mps and stack.navigation.local_planner.dwa.max_speed_mps in "
                        "imported.yaml |"));
  Import slow(with_limit(kMotor));
  slow.load();
  EXPECT_THAT(slow.assumptions(), Not(HasSubstr("| speed |")));
}

/// Car whose steering joints have this type and content.
std::string car(const std::string& type, const std::string& limit) {
  std::string text = chassis();
  for (const auto& [side, y] : {std::pair{"l", "0.25"}, {"r", "-0.25"}}) {
    const std::string knuckle = std::string("knuckle_") + side;
    text += joint(std::string("steer_") + side, type, "base_link", knuckle, fmt::format("0.4 {} -0.05", y),
                  axis("0 0 1") + limit) +
            link(knuckle, inertial(0.5)) + wheel(std::string("f") + side, knuckle, "0 0 0", 0.1, 0.05, "") +
            wheel(std::string("r") + side, "base_link", fmt::format("-0.1 {} -0.05", y), 0.1, 0.05) +
            fmt::format(R"(<transmission name="t{0}"><joint name="steer_{0}"/></transmission>)"
                        R"(<transmission name="d{0}"><joint name="r{0}_joint"/></transmission>)",
                        side);
  }
  return robot(text);
}

TEST(DriveLimits, AContinuousSteeringJointHasTheLimitsOfItsElementIfTheyAreThoseOfSteering) {
  Import limited(car("continuous", R"(<limit lower="-0.9" upper="1.0" effort="20" velocity="3"/>)"));
  limited.load();
  EXPECT_THAT(limited.robot.urdf, HasSubstr("lower=\"-0.9\" upper=\"1\""));
  EXPECT_THAT(limited.assumptions(), HasSubstr("| steer_l, steer_r | steering angle is -0.9 to 1 rad by &lt;limit>, "
                                               "although its type is continuous | type revolute of the joint |"));
  for (const char* limit : {R"(<limit effort="20" velocity="3"/>)", R"(<limit lower="-100" upper="100"/>)"}) {
    Import unlimited(car("continuous", limit));
    unlimited.load();
    EXPECT_THAT(unlimited.robot.urdf, HasSubstr("lower=\"-0.6\" upper=\"0.6\""));
    EXPECT_THAT(unlimited.assumptions(),
                HasSubstr("steering angle is limited to 0.6 rad: the joint has no limits | type revolute and"));
  }
}

TEST(DriveLimits, FrictionOfGazeboOnWheelsAndCastersIsARow) {
  const auto mu = [](const std::string& link, const std::string& mu1, const std::string& mu2) {
    return fmt::format(R"(<gazebo reference="{}"><mu1 value="{}"/><mu2>{}</mu2></gazebo>)", link, mu1, mu2);
  };
  const std::string ball = joint("ball_joint", "fixed", "base_link", "ball", "-0.25 0 -0.12") +
                           link("ball", inertial(0.3) + shape("collision", sphere(0.03)));
  Import import(robot(chassis() + two_wheels() + ball + mu("left", "0.5", "0.5") + mu("right", "0.8", "0.8") +
                      mu("ball", "0.05", "0.05") + mu("base_link", "0.1", "0.1")));
  import.load();
  EXPECT_THAT(
      import.assumptions(),
      AllOf(HasSubstr("| left | friction mu1 = 0.5, mu2 = 0.5 of &lt;gazebo> is not used: 0.8 is simulated on "
                      "all wheels | wheel_drive.friction in imported.yaml |"),
            HasSubstr("| ball | friction mu1 = 0.05, mu2 = 0.05 of &lt;gazebo> is not used: it rolls as a ball"),
            Not(HasSubstr("| right | friction")), Not(HasSubstr("| base_link | friction"))));
}

}  // namespace
}  // namespace patrol::importer::drive_limits_import_test
