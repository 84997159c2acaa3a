#include "importer/site/site_format.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/error.h"
#include "tests/support/temporary_file.h"

namespace patrol::importer::site_format_test {
namespace {

using ::testing::HasSubstr;
using ::testing::ThrowsMessage;

TEST(SiteFormat, FollowsTheExtensionInAnyCase) {
  EXPECT_EQ(site_format("plan.yaml"), SiteFormat::kPlan);
  EXPECT_EQ(site_format("drive.LOG"), SiteFormat::kLog);
  EXPECT_EQ(site_format("drive.clf.gz"), SiteFormat::kLog);
  EXPECT_EQ(site_format("Hall.STL"), SiteFormat::kMesh);
  EXPECT_EQ(site_format("hall.sdf.xacro"), SiteFormat::kSdf);
  EXPECT_EQ(site_format("hall.world.xacro"), SiteFormat::kSdf);
  const test::TemporaryFolder folder;
  EXPECT_EQ(site_format(folder.path()), SiteFormat::kScans);
  EXPECT_EQ(site_format("hall.E57"), SiteFormat::kScans);
}

TEST(SiteFormat, UnknownExtensionsAreRefusedWithThoseOfLogsAndFoldersOfScans) {
  EXPECT_THAT([] { site_format("robot.urdf.xacro"); },
              ThrowsMessage<InputError>(HasSubstr(".sdf.xacro, .world.xacro")));
  EXPECT_THAT([] { site_format("room.dwg"); },
              ThrowsMessage<InputError>(testing::AllOf(HasSubstr("room.dwg: extension of a site file must be one of "),
                                                       HasSubstr(".mcap, .clf, .log, .gz"), HasSubstr("scans"))));
}

TEST(SiteFormat, OptionsWithoutEffectAreRefusedWithTheFormatsThatUseThem) {
  const auto refusal = [](const std::string& file, const std::string& option) -> std::string {
    try {
      refuse_unused_options(file, {"--start", option});
    } catch (const InputError& error) {
      return error.what();
    }
    return "accepted";
  };
  EXPECT_EQ(refusal("a.yaml", "--scale"), "--scale: has no effect on a.yaml: only for meshes, point clouds and scans");
  EXPECT_EQ(refusal("a.sdf", "--up"), "--up: has no effect on a.sdf: only for meshes, point clouds and scans");
  EXPECT_EQ(refusal("a.stl", "--wall-height"),
            "--wall-height: has no effect on a.stl: only for floor plans and lidar logs");
  EXPECT_EQ(refusal("a.xml", "--contact-cell"), "--contact-cell: has no effect on a.xml: only for meshes and SDF");
  EXPECT_EQ(refusal("a.obj", "--package"), "--package: has no effect on a.obj: only for SDF");
  EXPECT_EQ(refusal("a.obj", "--without"), "--without: has no effect on a.obj: only for SDF");
  EXPECT_EQ(refusal("a.obj", "--xacro-arg"), "--xacro-arg: has no effect on a.obj: only for SDF");
  EXPECT_EQ(refusal("a.log", "--wall-height"), "accepted");
  EXPECT_EQ(refusal("a.world", "--contact-cell"), "accepted");
  EXPECT_EQ(refusal("a.pcd", "--scale"), "accepted");
  EXPECT_EQ(refusal("a.yaml", "--seed"), "accepted");
}

}  // namespace
}  // namespace patrol::importer::site_format_test
