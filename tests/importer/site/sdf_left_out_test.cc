#include "importer/site/sdf_left_out.h"

#include <filesystem>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/importer/site/mesh_files.h"
#include "tests/importer/site/sdf_text.h"
#include "tests/support/temporary_file.h"

namespace patrol::importer::sdf_left_out_test {
namespace {

using sdf_text::kBox, sdf_text::link, sdf_text::model, sdf_text::visual, sdf_text::world;

const std::string kSun = "<include><uri>model://sun</uri></include>\n";

TEST(SdfLeftOut, SeveralSunsAreOneRowWithTheLineOfTheirFirstInclude) {
  SiteFileImport import("a.sdf", world(kSun + kSun + "<light name='sun' type='point'/>\n" + model("m", visual(kBox))));
  import.read();
  EXPECT_EQ(import.assumption("<light>"), "ignored: the site has one sun (3, the first in line 5)");
  EXPECT_EQ(import.assumption("model://sun"), "");
  SiteFileImport one("a.sdf", world("\n" + kSun + model("m", visual(kBox))));
  one.read();
  EXPECT_EQ(one.assumption("<light>"), "ignored: the site has one sun (line 4)");
}

TEST(SdfLeftOut, ActorsAndRoadsAreLeftOutWithRows) {
  SiteFileImport import("a.sdf", world(model("m", visual(kBox)) +
                                       "<actor name='a'><skin><filename>a.dae</filename></skin></actor>\n"
                                       "<road name='r'><point>0 0 0</point></road>\n"
                                       "<include><uri>model://walker</uri></include>"));
  std::filesystem::create_directories(import.folder / "models/walker");
  test::write_bytes(import.folder / "models/walker/model.config",
                    "<model><name>walker</name><sdf version=\"1.6\">model.sdf</sdf></model>");
  test::write_bytes(import.folder / "models/walker/model.sdf", "<sdf version=\"1.6\"><actor name='walker'/></sdf>");
  EXPECT_EQ(import.read().shapes.size(), 1u);
  EXPECT_EQ(import.assumption("<actor>"), "left out: animated actors are not supported (2, the first in line 4)");
  EXPECT_EQ(import.assumption("<road>"), "left out: a picture without contact (line 5)");
}

TEST(SdfLeftOut, AnImpossibleInertiaIsNoError) {
  const std::string inertial =
      "<inertial><mass>1</mass><inertia><ixx>1</ixx><iyy>9</iyy><izz>1</izz></inertia></inertial>";
  SiteFileImport import("a.sdf", world("<model name='m'>" + link(inertial + visual(kBox)) + "</model>"));
  EXPECT_EQ(import.read().shapes.size(), 1u);
  EXPECT_EQ(import.assumption("<inertial>"), "");
}

TEST(SdfLeftOut, ElementsWithAColonHaveTheirLine) {
  SiteFileImport import("a.sdf", world(model("m", visual(kBox)) + "<gz:a/>\n<gz:a/>\n<gz:b/>"));
  import.read();
  EXPECT_EQ(import.assumption("<gz:a>"), "ignored: not an element of the format (2, the first in line 4)");
  EXPECT_EQ(import.assumption("<gz:b>"), "ignored: not an element of the format (line 6)");
}

TEST(SdfLeftOut, ModelsAreLeftOutByTheirNamesBeforeTheirFilesAreSearched) {
  SiteFileImport import("a.sdf",
                        world(model("m", visual(kBox)) + model("robot", visual("<mesh><uri>a.dae</uri></mesh>")) +
                              "<include><uri>model://absent</uri></include>"
                              "<include><uri>model://absent</uri><name>burger</name></include>"));
  import.options.without = {"robot", "absent", "burger"};
  EXPECT_EQ(import.read().shapes.size(), 1u);
  EXPECT_EQ(import.assumption("model robot"), "left out");
  import.options.without = {"robt"};
  EXPECT_EQ(import.error(), "--without robt: is not a model of a.sdf: did you mean robot?");
  import.options.without = {"xyzzy"};
  EXPECT_EQ(import.error(), "--without xyzzy: is not a model of a.sdf: it has absent, burger, m, robot");
}

}  // namespace
}  // namespace patrol::importer::sdf_left_out_test
