#include "importer/site/mjcf_options.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/importer/site/mesh_files.h"

namespace patrol::importer::mjcf_options_test {
namespace {

using ::testing::HasSubstr;

std::string with_floor(const std::string& options) {
  return "<mujoco>\n" + options + "<worldbody><geom type=\"plane\" size=\"5 5 1\"/></worldbody></mujoco>";
}

TEST(MjcfOptions, OptionsThatContradictTheSimulatorAreReplacedWithARow) {
  SiteFileImport import("a.xml", with_floor(R"(<option timestep="0.005" integrator="RK4" density="1.2" cone="elliptic">
<flag contact="disable"/></option><compiler settotalmass="10" boundmass="0" autolimits="true"/><size memory="1K"/>
)"));
  const sim::ModelPtr model = import.model();
  EXPECT_EQ(model->opt.timestep, 0.002);
  EXPECT_EQ(model->opt.integrator, mjINT_EULER);
  EXPECT_EQ(model->opt.density, 0.0);
  EXPECT_EQ(model->opt.disableflags, 0);
  EXPECT_EQ(model->opt.cone, mjCONE_ELLIPTIC);
  EXPECT_EQ(import.assumption("<option>, line 2 of a.xml"),
            "timestep = 0.005 is 0.002, integrator = RK4 is Euler, density = 1.2 is 0, flag contact = disable is "
            "removed: physics is that of all sites");
  EXPECT_EQ(import.assumption("<compiler>, line 3 of a.xml"),
            "settotalmass = 10 is removed: physics is that of all sites");
  EXPECT_EQ(import.assumption("<size>, line 3 of a.xml"), "memory = 1K is removed: physics is that of all sites");
}

TEST(MjcfOptions, OptionsThatAgreeWithTheSimulatorHaveNoRow) {
  SiteFileImport import("a.xml", with_floor(R"(<option timestep="2e-3" gravity="0 0 -9.8" integrator="Euler"/>
)"));
  EXPECT_EQ(import.read().assumptions.size(), 2u);
}

TEST(MjcfOptions, GravityOtherThanThatOfTheEarthIsRefusedWithFileAndLine) {
  EXPECT_EQ(SiteFileImport("a.xml", with_floor("<option gravity=\"0 0 -1.62\"/>")).error(),
            "a.xml:2: <option>: gravity: must be that of the earth, 0 0 -9.81");
  EXPECT_EQ(SiteFileImport("a.xml", with_floor("<option>\n<flag gravity=\"disable\"/></option>")).error(),
            "a.xml:3: <flag>: gravity: must be that of the earth, 0 0 -9.81");
  SiteFileImport import("a.xml", with_floor("<include file=\"b.xml\"/>"));
  test::write_bytes(import.folder / "b.xml", "<mujoco>\n\n<option gravity=\"0 0 0\"/></mujoco>");
  EXPECT_EQ(import.error(), "b.xml:3: <option>: gravity: must be that of the earth, 0 0 -9.81");
}

}  // namespace
}  // namespace patrol::importer::mjcf_options_test
