#include <algorithm>
#include <string>
#include <utility>

#include <Eigen/Core>
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/importer/robot/description.h"
#include "tests/importer/robot/import.h"
#include "tests/support/simulated_wheeled_robot.h"

/// Masses and inertias of public descriptions.
namespace patrol::importer::description_inertia_test {
namespace {

using ::testing::AllOf, ::testing::HasSubstr, ::testing::MatchesRegex, ::testing::Not;

std::string inertial_of(double mass_kg, const std::string& tensor) {
  return fmt::format(R"(<inertial><mass value="{}"/><inertia {}/></inertial>)", mass_kg, tensor);
}

std::string diagonal(double xx, double yy, double zz) {
  return fmt::format(R"(ixx="{}" ixy="0" ixz="0" iyy="{}" iyz="0" izz="{}")", xx, yy, zz);
}

const std::string kOnes = R"(ixx="1e-6" ixy="1e-6" ixz="1e-6" iyy="1e-6" iyz="1e-6" izz="1e-6")";

TEST(PublicDescription, PlaceholderInertiasOfLightLinksAreReplacedInOneRow) {
  Import import(with(part("antenna", inertial_of(0.001, kOnes)) + part("mark", inertial_of(0.001, kOnes))));
  EXPECT_NEAR(import.load().mass_kg, 22.502, 1e-6);
  EXPECT_THAT(import.assumptions(), HasSubstr("| antenna, mark | no body has these inertias: replaced by the nearest "
                                              "possible ones; with moments of at most 3e-06 kg m2"));
}

TEST(PublicDescription, ASmallViolationIsReplacedByTheNearestInertiaOfABody) {
  Import import(with(part("arm", inertial_of(1.0, diagonal(4e-4, 1.8e-3, 2.3e-3)))));
  import.load();
  EXPECT_THAT(import.assumptions(),
              HasSubstr("| arm | its principal moments of inertia 0.0004, 0.0018 and 0.0023 kg m2 are replaced by "
                        "0.000451, 0.00185 and 0.0023: in a body, none exceeds the sum of the others |"));
  EXPECT_THAT(import.assumptions(), Not(HasSubstr("adjusted by up to 1 %")));
}

TEST(PublicDescription, AnInertiaThatIsFarFromThatOfABodyIsRefused) {
  Import arm(with(part("arm", inertial_of(1.0, diagonal(4e-4, 1.5e-3, 2.3e-3)))));
  EXPECT_THAT(complaint(arm), MatchesRegex("vendor.urdf:[0-9]+: arm: invalid inertia: principal moments 0.0004, 0.0015 "
                                           "and 0.0023 kg m2: .*"));
  Import light(with(part("antenna", inertial_of(0.001, diagonal(0.001, 0.001, 0.01)))));
  EXPECT_THAT(complaint(light), HasSubstr("antenna: invalid inertia")) << "a light link with a large moment";
}

TEST(PublicDescription, AMasslessLinkIsLeftOutOnAJointThatIsFixed) {
  Import import(with(joint("j", "continuous", "base_link", "tip", "0.1 0 0.1", axis("0 0 1")) +
                     link("tip", inertial_of(0.0, kOnes))));
  EXPECT_NEAR(import.load().mass_kg, 22.5, 1e-6);
  EXPECT_THAT(import.assumptions(), HasSubstr("| tip | its &lt;inertial> with mass 0 is left out |"));
}

TEST(PublicDescription, APlaceholderMassOfTheBaseIsJoinedWithTheHeaviestLink) {
  Import import(robot(link("root", inertial_of(1e-6, kOnes)) + joint("j", "fixed", "root", "base_link", "0 0 0") +
                      chassis() + two_wheels()));
  EXPECT_NEAR(import.load().mass_kg, 22.000001, 1e-9);
  EXPECT_THAT(import.robot.urdf, HasSubstr("<mass value=\"19.34"))
      << "3 % of the mass are taken from it for the supports";
}

TEST(PublicDescription, LinksWithoutAnInertialAreARowInTheNumberOfTheirCount) {
  const std::string mast = part("mast", shape("collision", box(0.1, 0.1, 0.1)));
  const std::string rail = part("rail", shape("collision", box(0.1, 0.1, 0.1)));
  Import one(with(mast)), two(with(mast + rail));
  one.load();
  two.load();
  EXPECT_THAT(one.assumptions(), HasSubstr("| mast | has no &lt;inertial>: massless"));
  EXPECT_THAT(two.assumptions(), HasSubstr("| mast, rail | have no &lt;inertial>: massless"));
}

TEST(PublicDescription, ALightCasterGetsMassOfTheChassis) {
  std::string text = caster();
  for (const auto& [old, by] : {std::pair{"<mass value=\"0.3\"/>", "<mass value=\"0.03\"/>"},
                                {"<mass value=\"0.2\"/>", "<mass value=\"0.02\"/>"}})
    text.replace(text.find(old), std::string(old).size(), by);
  Import import(robot(chassis() + two_wheels() + text));
  EXPECT_NEAR(import.load().mass_kg, 22.05, 1e-6) << "of the robot, unchanged";
  EXPECT_THAT(import.assumptions(), AllOf(HasSubstr("| fork | its mass of 0.03 kg is raised to 0.331 kg, taken from "
                                                    "the chassis, and its moments of inertia to 0.00165 kg m2"),
                                          HasSubstr("| small | its mass of 0.02 kg is raised to 0.331 kg, taken from "
                                                    "the chassis, and its moments of inertia to 0.00165 kg m2")));
}

// The masses are not small, but the inertias are those of the small parts: without a larger inertia, the contacts of
// the casters chatter with several m/s2.
TEST(PublicDescription, ARobotWithCastersOfSmallInertiaStandsStill) {
  std::string text = link("base_link",
                          "<inertial><mass value=\"40\"/><inertia ixx=\"0.967\" ixy=\"0\" ixz=\"0\" iyy=\"2.83\" "
                          "iyz=\"0\" izz=\"3.53\"/></inertial>" +
                              shape("collision", box(0.9, 0.5, 0.2))) +
                     wheel("left", "base_link", "0 0.28 -0.05", 0.1, 0.05) +
                     wheel("right", "base_link", "0 -0.28 -0.05", 0.1, 0.05);
  for (const auto& [name, x] : {std::pair{"front", 0.38}, {"rear", -0.38}}) {
    const std::string fork = std::string(name) + "_fork";
    text += joint(std::string(name) + "_swivel", "continuous", "base_link", fork, fmt::format("{} 0 -0.09", x),
                  axis("0 0 1")) +
            link(fork, inertial(0.3, "0 0 0", 0.00018)) +
            joint(std::string(name) + "_roll", "continuous", fork, name, "-0.03 0 -0.02", axis("0 1 0")) +
            link(name, inertial(0.3, "0 0 0", 0.00024) + shape("collision", cylinder(0.04, 0.03), "0 0 0", kAcross));
  }
  Import import(robot(text));
  import.load();
  EXPECT_THAT(import.assumptions(),
              HasSubstr("| front_fork, rear_fork | its moment of inertia about the swivel axis of "
                        "0.00018 kg m2 is raised to 0.00104 kg m2"));
  const std::string level = R"(<mujoco><option timestep="0.002" cone="elliptic"/><worldbody>
    <geom name="ground" type="plane" size="20 20 1" contype="1" conaffinity="2"/></worldbody></mujoco>)";
  sim::WheeledRobot standing(level, import.robot.urdf);
  standing.drive(0.0, 0.0, 1.0);
  double max_mps2 = 0.0;
  for (int i = 0; i < 100; ++i) {
    const Eigen::Vector3d before_mps = standing.velocity_mps();
    standing.drive(0.0, 0.0, 0.002);
    max_mps2 = std::max(max_mps2, (standing.velocity_mps() - before_mps).norm() / 0.002);
  }
  EXPECT_LT(max_mps2, 0.1);
}

// 20 kg at 122 m.
TEST(PublicDescription, AChassisWithAnInertiaBeyondTheSizeOfTheRobotGetsThatOfItsShape) {
  Import import(robot(link("base_link", inertial(20.0, "0 0 0", 3e5) + shape("collision", box(0.6, 0.4, 0.2))) +
                      two_wheels() + caster()));
  import.load();
  EXPECT_THAT(import.assumptions(), HasSubstr("| base_link | its moment of inertia 3e+05 kg m2 is that of its 20 kg at "
                                              "a distance of 122 m"));
}

TEST(PublicDescription, AWheelWithTheInertiaOfAHouseHasThatOfItsShape) {
  std::string text = robot(chassis() + two_wheels() + caster());
  const std::string inertia = R"(<inertia ixx="0.01" ixy="0" ixz="0" iyy="0.01" iyz="0" izz="0.01"/>)";
  text.replace(text.find(inertia), inertia.size(), "<inertia " + diagonal(1.0, 1.0, 1.0) + "/>");
  Import import(text);
  import.load();
  EXPECT_THAT(import.assumptions(), HasSubstr("| left | its moment of inertia 1 kg m2 about the axle is that of 100 kg "
                                              "at its radius of 0.1 m, but its mass is 1 kg: replaced"));
  EXPECT_THAT(import.robot.urdf, HasSubstr("iyy=\"0.005\"")) << "m r^2 / 2";
}

TEST(PublicDescription, AMassAboveTwentyTonsIsReported) {
  Import import(robot(link("base_link", inertial(30000.0, "-0.1 0 0", 500.0) + shape("collision", box(0.6, 0.4, 0.2))) +
                      two_wheels() + caster()));
  import.load();
  EXPECT_THAT(import.assumptions(), HasSubstr("| mass | 30002 kg of the file are kept, although more than 20000 kg are "
                                              "unlikely: base_link has 29100 kg |"));
}

}  // namespace
}  // namespace patrol::importer::description_inertia_test
