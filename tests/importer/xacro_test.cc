#include "importer/xacro.h"

#include <algorithm>
#include <cstdlib>
#include <map>
#include <string>
#include <utility>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/error.h"
#include "importer/robot/robot_import.h"
#include "tests/importer/robot/description.h"
#include "tests/importer/robot/import.h"
#include "tests/support/pose_near.h"
#include "tests/support/temporary_file.h"
#include "tests/support/xacro.h"

namespace patrol::importer::xacro_test {
namespace {

using test::has_xacro, test::TemporaryFolder, test::write_bytes;
using ::testing::EndsWith, ::testing::HasSubstr, ::testing::MatchesRegex, ::testing::Not, ::testing::StartsWith;

TEST(Xacro, MacrosArgumentsAndFoundPackagesAreExpanded) {
  if (!has_xacro()) GTEST_SKIP() << "the Python package xacro is not installed";
  std::string text = robot(
      "<xacro:arg name=\"radius\" default=\"0.3\"/>\n<xacro:include filename=\"$(find my_robot)/body.xacro\"/>\n" +
      two_wheels() + caster());
  text.replace(text.find("<robot "), 7, "<robot xmlns:xacro=\"http://www.ros.org/wiki/xacro\" ");
  for (std::size_t at = 0; (at = text.find("radius=\"0.1\"", at)) != std::string::npos;)
    text.replace(at, 12, "radius=\"$(arg radius)\"");
  Import import(text, "vendor.urdf.xacro");
  std::filesystem::create_directory(import.folder / "elsewhere");
  write_bytes(import.folder / "elsewhere/body.xacro",
              "<robot xmlns:xacro=\"http://www.ros.org/wiki/xacro\">" + chassis() + "</robot>");
  import.options.packages["my_robot"] = import.folder / "elsewhere";
  import.options.xacro_arguments["radius"] = "0.1";
  import.load();
  const WheelGeometry& wheel = import.wheel("left");
  EXPECT_THAT(wheel.center_in_body, test::VectorNear(Eigen::Vector3d(0.0, 0.25, -0.05), 1e-6));
  EXPECT_NEAR(wheel.radius_m, 0.1, 1e-6);
  EXPECT_NEAR(wheel.width_m, 0.04, 1e-6);
}

TEST(Xacro, AFailedExpansionIsReportedInOneLine) {
  if (!has_xacro()) GTEST_SKIP() << "the Python package xacro is not installed";
  Import import("<robot xmlns:xacro=\"http://www.ros.org/wiki/xacro\" name=\"a\"><xacro:unknown_macro/></robot>",
                "a.xacro");
  try {
    import_robot(import.options);
    ADD_FAILURE();
  } catch (const InputError& error) {
    EXPECT_THAT(error.what(), HasSubstr("a.xacro:1: xacro: "));
    EXPECT_THAT(error.what(), HasSubstr("unknown_macro"));
    EXPECT_EQ(std::string(error.what()).find('\n'), std::string::npos);
  }
}

TEST(Xacro, AnErrorInAnIncludedMacroHasItsFileLineAndMacro) {
  if (!has_xacro()) GTEST_SKIP() << "the Python package xacro is not installed";
  const std::string head = "<robot xmlns:xacro=\"http://www.ros.org/wiki/xacro\" name=\"a\">\n";
  Import import(head + "<xacro:include filename=\"w.xacro\"/>\n<xacro:w n=\"left\"/>\n</robot>", "a.xacro");
  test::write_bytes(
      import.folder / "w.xacro",
      head + "<xacro:macro name=\"w\" params=\"n\">\n<link name=\"${n}_${sise}\"/>\n</xacro:macro>\n</robot>");
  try {
    import_robot(import.options);
    ADD_FAILURE();
  } catch (const InputError& error) {
    EXPECT_THAT(error.what(),
                EndsWith("w.xacro:3: xacro: name 'sise' is not defined when evaluating expression 'sise', "
                         "in macro w"));
  }
}

TEST(Xacro, AnUnknownPackageAndAMissingFileAreNamedOnce) {
  if (!has_xacro()) GTEST_SKIP() << "the Python package xacro is not installed";
  for (const auto& [name, message] :
       {std::pair{"$(find nopkg)/a.xacro",
                  "a.xacro:2: xacro: unknown package \"nopkg\": give its folder with --package "
                  "nopkg=FOLDER"},
        {"/nowhere/b.xacro", "a.xacro:2: xacro: No such file or directory: /nowhere/b.xacro"}}) {
    Import import("<robot xmlns:xacro=\"http://www.ros.org/wiki/xacro\" name=\"a\">\n<xacro:include filename=\"" +
                      std::string(name) + "\"/>\n</robot>",
                  "a.xacro");
    try {
      import_robot(import.options);
      ADD_FAILURE();
    } catch (const InputError& error) {
      EXPECT_THAT(error.what(), EndsWith(message));
    }
  }
}

const std::string kXacroRobot = "<robot xmlns:xacro=\"http://www.ros.org/wiki/xacro\" name=\"a\">\n";

/// Returns the message about a file of these lines in place of a robot, from the name of the file on.
std::string xacro_complaint(const std::string& lines, const std::map<std::string, std::string>& arguments = {},
                            const std::string& included = "") {
  Import import(kXacroRobot + lines + "</robot>\n", "a.xacro");
  if (!included.empty()) write_bytes(import.folder / "b.xacro", included);
  import.options.xacro_arguments = arguments;
  try {
    import_robot(import.options);
  } catch (const InputError& error) {
    const std::string what = error.what();
    return what.substr(what.find(import.folder.path().string()) + import.folder.path().string().size() + 1);
  }
  return "";
}

TEST(Xacro, AnArgumentThatTheFilesDoNotReadIsRefusedWithTheKnownOnes) {
  if (!has_xacro()) GTEST_SKIP() << "the Python package xacro is not installed";
  const std::string text =
      "<xacro:arg name=\"radius\" default=\"0.1\"/>\n<xacro:property name=\"side\" "
      "value=\"$(arg side)\"/>\n<link name=\"$(eval 'a' if mode else 'b')\"/>\n";
  EXPECT_EQ(xacro_complaint(text, {{"side", "l"}, {"mode", "1"}, {"radus", "0.2"}}),
            "a.xacro: xacro: --xacro-arg radus: unknown argument (known: radius, side)");
  EXPECT_THAT(xacro_complaint(text, {{"side", "l"}, {"mode", "1"}, {"radius", "0.2"}}), HasSubstr("no wheels found"));
  Import plain(with(""));
  plain.options.xacro_arguments["radius"] = "0.1";
  EXPECT_THAT(complaint(plain), HasSubstr("vendor.urdf: --xacro-arg radius: unknown argument: the file has no"));
}

TEST(Xacro, AnArgumentWithoutAValueIsReportedWithTheOptionThatGivesIt) {
  if (!has_xacro()) GTEST_SKIP() << "the Python package xacro is not installed";
  EXPECT_EQ(xacro_complaint("<link name=\"x\"/>\n<xacro:if value=\"$(arg is_sim)\"/>\n"),
            "a.xacro:3: xacro: argument is_sim has no value: give --xacro-arg is_sim=VALUE");
}

TEST(Xacro, AnErrorHasTheLineOfTheElementOrPropertyThatHasItAndNotOfTheMacroThatIsCalled) {
  if (!has_xacro()) GTEST_SKIP() << "the Python package xacro is not installed";
  const std::string macro = kXacroRobot +
                            "<xacro:macro name=\"m\" params=\"mass\">\n<link name=\"${mass}\"/>\n"
                            "</xacro:macro>\n</robot>\n";
  const std::string include = "<xacro:include filename=\"b.xacro\"/>\n";
  EXPECT_EQ(xacro_complaint(include + "<link name=\"x\"/>\n<xacro:m\n  mass=\"${unknown}\"/>\n", {}, macro),
            "a.xacro:5: xacro: name 'unknown' is not defined when evaluating expression 'unknown'");
  EXPECT_EQ(xacro_complaint(include + "<xacro:m mas=\"1\"/>\n", {}, macro),
            "a.xacro:3: xacro: Invalid parameter \"mas\" of macro m");
  EXPECT_EQ(xacro_complaint(include + "<xacro:n mass=\"1\"/>\n", {}, macro),
            "a.xacro:3: xacro: unknown macro name: xacro:n");
  EXPECT_THAT(xacro_complaint("<xacro:property name=\"p\" value=\"${xacro.load_yaml('no.yaml')}\"/>\n" + include +
                                  "<xacro:m mass=\"1\"/>\n<link name=\"${p}\"/>\n",
                              {}, macro),
              StartsWith("a.xacro:2: xacro: No such file or directory: '"));
}

TEST(Xacro, AnIncludedFileThatIsNoXmlIsNamedWithItsLine) {
  if (!has_xacro()) GTEST_SKIP() << "the Python package xacro is not installed";
  const std::string include = "<xacro:include filename=\"b.xacro\"/>\n";
  EXPECT_EQ(xacro_complaint(include, {}, "<!-- license -->\n<?xml version=\"1.0\"?>\n" + kXacroRobot + "</robot>"),
            "b.xacro:2: xacro: not an XML file: <?xml ...?> must be at its very start");
  EXPECT_EQ(xacro_complaint(include, {}, kXacroRobot + "<link>\n</robot>"),
            "b.xacro:3: xacro: not an XML file: mismatched tag");
}

TEST(Xacro, MessagesAndRowsAboutTheExpandedRobotHaveTheFileAndLineOfTheElement) {
  if (!has_xacro()) GTEST_SKIP() << "the Python package xacro is not installed";
  const std::string macro = kXacroRobot + "<xacro:macro name=\"m\" params=\"mass\">\n<link name=\"x\">" +
                            "<inertial>\n<mass value=\"${mass}\"/></inertial></link>\n</xacro:macro>\n</robot>\n";
  EXPECT_EQ(xacro_complaint("<xacro:include filename=\"b.xacro\"/>\n<xacro:m mass=\"-1\"/>\n", {}, macro),
            "b.xacro:4: x: mass = -1: must be positive");
  EXPECT_EQ(xacro_complaint("<link name=\"x\"/>\n<link name=\"x\"/>\n"),
            "a.xacro:3: x: duplicate link: also in a.xacro:2");
  Import import(kXacroRobot + "<xacro:arg name=\"a\" default=\"\"/>\n" + chassis() + two_wheels() + caster() +
                    "<gazebo reference=\"nowhere\"><sensor type=\"ray\" name=\"s\"/></gazebo>\n</robot>\n",
                "a.xacro");
  import.load();
  EXPECT_THAT(import.assumptions(), HasSubstr("| nowhere | unknown link: its sensor in a.xacro:"));
}

TEST(Xacro, AMissingInterpreterIsReportedInOneLine) {
  const char* before = std::getenv("PATROL_PYTHON");
  const std::string saved = before != nullptr ? before : "";
  ::setenv("PATROL_PYTHON", "/nowhere/python", 1);
  Import import("<robot/>", "a.xacro");
  try {
    import_robot(import.options);
    ADD_FAILURE();
  } catch (const InputError& error) {
    EXPECT_THAT(error.what(), HasSubstr("a.xacro: xacro is not available"));
  }
  if (before != nullptr) ::setenv("PATROL_PYTHON", saved.c_str(), 1);
  else ::unsetenv("PATROL_PYTHON");
}

}  // namespace
}  // namespace patrol::importer::xacro_test
