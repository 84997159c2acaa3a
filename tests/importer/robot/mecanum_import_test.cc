#include <array>
#include <cmath>
#include <string>

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/error.h"
#include "core/wheel_kinematics.h"
#include "tests/importer/robot/description.h"
#include "tests/importer/robot/import.h"

namespace patrol::importer::mecanum_import_test {
namespace {

using ::testing::HasSubstr;

/// Rollers on joints around the hub of a wheel, whose axle is y.
struct Rollers {
  int count = 8;
  double distance_m = 0.08;  ///< distance of the roller axes from the axle
  double radius_m = 0.02;
  double length_m = 0.05;
  std::string motor = "";  ///< content of the joints
};

/// A roller whose axis on the ground is at `axis_rad` from x to the left, at an angle about the axle from the ground.
std::string roller(const std::string& name, const std::string& hub, double axis_rad, double angle_rad,
                   const Rollers& rollers) {
  const Eigen::Vector3d outward(-std::sin(angle_rad), 0.0, -std::cos(angle_rad)), axle(0.0, 1.0, 0.0);
  const Eigen::Vector3d direction = std::cos(axis_rad) * outward.cross(axle) + std::sin(axis_rad) * axle;
  const Eigen::Vector3d at = rollers.distance_m * outward;
  const std::string rpy =
      fmt::format("{:.9f} {:.9f} 0", -std::asin(direction.y()), std::atan2(direction.x(), direction.z()));
  return joint(name + "_joint", "continuous", hub, name, fmt::format("{:.9f} {:.9f} {:.9f}", at.x(), at.y(), at.z()),
               axis(fmt::format("{:.9f} {:.9f} {:.9f}", direction.x(), direction.y(), direction.z())) + rollers.motor) +
         link(name, inertial(0.02, "0 0 0", 1e-5) +
                        shape("collision", cylinder(rollers.radius_m, rollers.length_m), "0 0 0", rpy));
}

/// Four hubs with rollers, 0.4 m long and 0.5 m wide. `axis_rad`: of the front left, front right, rear left and rear
/// right rollers on the ground.
std::string with_rollers(const std::array<double, 4>& axis_rad, const Rollers& rollers = {}) {
  std::string text = chassis();
  for (int i = 0; i < 4; ++i) {
    const std::string hub = fmt::format("part{}", i);
    text += wheel(hub, "base_link", fmt::format("{} {} -0.05", i < 2 ? 0.2 : -0.2, i % 2 == 0 ? 0.25 : -0.25), 0.05,
                  0.02, kMotor, i % 2 == 0 ? "0 1 0" : "0 -1 0");
    for (int k = 0; k < rollers.count; ++k)
      text += roller(fmt::format("{}_{}", hub, k), hub, axis_rad.at(static_cast<std::size_t>(i)),
                     2.0 * M_PI * k / rollers.count, rollers);
  }
  return robot(text);
}

constexpr double k45 = M_PI / 4.0;
constexpr std::array<double, 4> kPatternX = {-k45, k45, k45, -k45};

std::string complaint(const std::string& text, const std::string& drive = "") {
  Import import(text, "v.urdf");
  import.options.drive = drive;
  try {
    import.load();
  } catch (const InputError& error) {
    return std::filesystem::path(error.what()).filename().string();
  }
  return "";
}

TEST(MecanumImport, RollersOnJointsGiveTheDriveThePatternTheRadiusAndTheWidthTo1Millimeter) {
  Import import(with_rollers(kPatternX));
  import.load();
  EXPECT_EQ(import.description.wheels.size(), 4U);
  for (const WheelGeometry& wheel : import.description.wheels) {
    EXPECT_NEAR(wheel.radius_m, 0.1, 1e-3);
    EXPECT_NEAR(wheel.width_m, 0.05 * std::sqrt(0.5), 1e-3);
    EXPECT_NEAR(std::abs(wheel.center_in_body.y()), 0.25, 1e-6);
  }
  EXPECT_THAT(import.robot.settings, HasSubstr("wheel_drive:\n  type: mecanum\n  roller_pattern: x\n"
                                               "  roller_angle_rad: 0.7854\n"));
  EXPECT_THAT(import.robot.settings, HasSubstr("kinematics: omnidirectional"));
  EXPECT_THAT(import.assumptions(), HasSubstr("32 links on joints are fixed to their wheels"));
}

TEST(MecanumImport, TheRollersOfEachWheelAreThoseOfItsMassAndItsVisuals) {
  Import import(with_rollers(kPatternX));
  import.load();
  EXPECT_NEAR(import.description.mass_kg, 20.0 + 4.0 * (1.0 + 8 * 0.02), 1e-6);
}

TEST(MecanumImport, ThePatternOAndAnAngleOf30DegreesToTheAxleAreFound) {
  const double slope = M_PI / 3.0;
  Import import(with_rollers({slope, -slope, -slope, slope}));
  import.load();
  EXPECT_THAT(import.robot.settings, HasSubstr("roller_pattern: o\n  roller_angle_rad: 0.5236\n"));
}

TEST(MecanumImport, ADescriptionThatDrivesAlongYHasTheSamePattern) {
  std::string text = chassis("base_link");
  for (int i = 0; i < 4; ++i) {  // the robot above, turned by 90 degrees
    const std::string hub = fmt::format("part{}", i), mount = hub + "_mount";
    const double x = i < 2 ? 0.2 : -0.2, y = i % 2 == 0 ? 0.25 : -0.25;
    text += joint(mount, "fixed", "base_link", mount, fmt::format("{} {} -0.05", -y, x), "", "0 0 1.5707963267948966") +
            link(mount) + wheel(hub, mount, "0 0 0", 0.05, 0.02);
    for (int k = 0; k < 8; ++k)
      text +=
          roller(fmt::format("{}_{}", hub, k), hub, kPatternX.at(static_cast<std::size_t>(i)), 2.0 * M_PI * k / 8, {});
  }
  Import import(robot(text));
  import.load();
  EXPECT_THAT(import.robot.settings, HasSubstr("roller_pattern: x\n"));
}

TEST(MecanumImport, PlainCylindersWithTheOptionHaveThePatternXAsAnAssumption) {
  const std::string text = robot(chassis() + two_wheels() + wheel("a", "base_link", "0.3 0.25 -0.05", 0.1, 0.04) +
                                 wheel("b", "base_link", "0.3 -0.25 -0.05", 0.1, 0.04));
  Import import(text);
  import.options.drive = "mecanum";
  import.load();
  EXPECT_THAT(import.robot.settings, HasSubstr("roller_pattern: x\n"));
  EXPECT_THAT(import.robot.settings, HasSubstr("max_lateral_speed_mps: 0.50"));
  EXPECT_THAT(import.assumptions(), HasSubstr("those of the upper rollers form an X: the file has none"));
}

TEST(MecanumImport, RefusesWhatIsNoMecanumDriveWithLineAndElement) {
  using ::testing::MatchesRegex;
  const std::string three = robot(chassis() + two_wheels() + caster());
  EXPECT_THAT(complaint(three, "mecanum"),
              MatchesRegex("v.urdf:[0-9]+: .*: one of 3 wheels: a mecanum drive must have four"));
  const std::string passive =
      robot(chassis() + two_wheels() + wheel("a", "base_link", "0.3 0.25 -0.05", 0.1, 0.04, "") +
            wheel("b", "base_link", "0.3 -0.25 -0.05", 0.1, 0.04, ""));
  EXPECT_THAT(complaint(passive, "mecanum"), MatchesRegex("v.urdf:[0-9]+: a_joint: has no motor: all wheels.*"));
  EXPECT_THAT(
      complaint(with_rollers({-k45, k45, k45, k45})),
      MatchesRegex("v.urdf:[0-9]+: part0_joint: rollers of 3 wheels form an X seen from above, those of 1 an O.*"));
  EXPECT_THAT(
      complaint(with_rollers({0.0, 0.0, 0.0, 0.0})),
      MatchesRegex("v.urdf:[0-9]+: part0: has 8 rollers on joints: not supported: their axes are at 90 degrees.*"));
  const double square = std::atan(0.25 / 0.2);  // the axes on the ground meet in the middle
  EXPECT_THAT(complaint(with_rollers({square, -square, -square, square})),
              MatchesRegex("v.urdf:[0-9]+: part0_joint: rollers on the ground point at the middle of the robot.*"));
  EXPECT_THAT(complaint(with_rollers(kPatternX), "differential"),
              MatchesRegex("v.urdf: drive differential: the wheels have rollers: must be mecanum"));
}

}  // namespace
}  // namespace patrol::importer::mecanum_import_test
