#include "importer/site/sdf_source.h"

#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/importer/site/mesh_files.h"
#include "tests/importer/site/sdf_text.h"
#include "tests/support/xacro.h"

namespace patrol::importer::sdf_source_test {
namespace {

using sdf_text::kBox, sdf_text::model, sdf_text::shape_of, sdf_text::visual, sdf_text::world;
using ::testing::HasSubstr, ::testing::StartsWith;

TEST(SdfSource, VersionsWithAnotherSyntaxAreRefusedWithWhatToChange) {
  for (const std::string version : {"1.0", "1.2"}) {
    EXPECT_EQ(SiteFileImport("a.sdf", world(model("m", visual(kBox)), version)).error(),
              "a.sdf:2: <sdf>: version = \"" + version +
                  "\": must be 1.3 to 1.12: write <origin pose=\"...\"> as <pose>, and attributes as elements");
  }
  EXPECT_EQ(SiteFileImport("a.sdf", world(model("m", visual(kBox)), "1.3")).error(), "accepted");
}

TEST(SdfSource, FilesInUtf16AndOfOtherSimulatorsAreRefusedByName) {
  EXPECT_EQ(SiteFileImport("a.sdf", std::string("\xFF\xFE<\0s\0", 6)).error(),
            "a.sdf: is encoded as UTF-16: must be UTF-8");
  EXPECT_EQ(
      SiteFileImport("a.world", "# Stage\ninclude \"map.inc\"\n").error(),
      "a.world: not XML: must be SDF; of a world of Stage, import the picture of its map as a floor plan (.yaml)");
  EXPECT_EQ(SiteFileImport("a.sdf", "\xEF\xBB\xBF" + world(model("m", visual(kBox)))).error(), "accepted");
}

const std::string kWall = R"(<xacro:property name="half" value="4"/>
<xacro:macro name="wall" params="n x"><model name="${n}"><static>true</static><pose>${x} 0 0 0 0 0</pose><link name="link">)" +
                          visual("<box><size>$(arg length) 1 1</size></box>") + R"(</link></model></xacro:macro>
<xacro:wall n="w" x="${half}"/>)";

std::string xacro_world(const std::string& elements) {
  std::string text = world(elements);
  text.replace(text.find("<sdf "), 5, "<sdf xmlns:xacro=\"http://www.ros.org/wiki/xacro\" ");
  return text;
}

TEST(SdfSource, XacroIsExpandedByNameAndByText) {
  if (!test::has_xacro()) GTEST_SKIP() << "the Python package xacro is not installed";
  for (const std::string file : {"a.sdf", "a.sdf.xacro", "a.world.xacro"}) {
    SiteFileImport import(file, xacro_world("<xacro:arg name=\"length\" default=\"2\"/>" + kWall));
    import.options.xacro_arguments["length"] = "6";
    const SiteShape& wall = shape_of(import.read(), "w.link.visual");
    EXPECT_EQ(wall.T_site_shape.position.x(), 4.0);
    EXPECT_EQ(wall.size_m.x(), 3.0);
    EXPECT_EQ(import.assumption("a.sdf"), file == "a.sdf" ? "has expressions of xacro and is expanded by xacro" : "");
  }
  EXPECT_THAT(SiteFileImport("a.sdf", xacro_world(kWall)).error(), StartsWith("a.sdf"));
  EXPECT_THAT(SiteFileImport("a.sdf", xacro_world("<xacro:property name=\"x\" value=\"1\"/><model name='m'/>")).error(),
              HasSubstr("a.sdf:"));
}

}  // namespace
}  // namespace patrol::importer::sdf_source_test
