#include "importer/xacro.h"

#include <algorithm>
#include <cstdlib>
#include <string>
#include <utility>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/error.h"
#include "importer/robot_import.h"
#include "tests/importer/description.h"
#include "tests/importer/import.h"
#include "tests/support/pose_near.h"
#include "tests/support/temporary_file.h"
#include "tests/support/xacro.h"

namespace patrol::importer::xacro_test {
namespace {

using test::has_xacro, test::TemporaryFolder, test::write_bytes;
using ::testing::EndsWith, ::testing::HasSubstr, ::testing::MatchesRegex, ::testing::Not;

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
    EXPECT_THAT(error.what(), HasSubstr("a.xacro: xacro: "));
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
