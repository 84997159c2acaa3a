#include "importer/site/mjcf_site.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/error.h"
#include "importer/site/texture_image.h"
#include "tests/importer/site/mesh_files.h"

namespace patrol::importer::mjcf_site_test {
namespace {

using ::testing::HasSubstr;

std::string box_obj() {
  Mesh box;
  add_box(box, {0, 0, 0}, {1, 1, 1});
  return to_obj(box);
}

TEST(MjcfSite, AModelIsCopiedWithItsIncludesMeshesAndTextures) {
  SiteFileImport import("model.xml", R"(<mujoco model="m"><compiler meshdir="assets" texturedir="pictures"/>
<include file="parts/assets.xml"/>
<worldbody><geom name="floor" type="plane" size="5 5 1"/><geom name="crate" type="mesh" mesh="crate" material="brick"/>
<body name="door" pos="2 0 1"><joint name="hinge"/><geom type="box" size="0.5 0.05 1" mass="3"/></body></worldbody>
<actuator><motor joint="hinge"/></actuator></mujoco>)");
  for (const char* folder : {"assets/a", "assets/b", "pictures", "parts"})
    std::filesystem::create_directories(import.folder / folder);
  test::write_bytes(import.folder / "assets/a/crate.obj", box_obj());
  test::write_bytes(import.folder / "assets/b/crate.obj", box_obj());
  test::write_bytes(import.folder / "pictures/brick.png", encode_png({.width = 1, .height = 1, .rgb = {200, 80, 60}}));
  test::write_bytes(import.folder / "parts/assets.xml",
                    R"(<mujoco><asset><mesh file="a/crate.obj"/><mesh name="second" file="b/crate.obj"/>
<texture name="brick" type="2d" file="brick.png"/><material name="brick" texture="brick"/></asset></mujoco>)");
  const sim::ModelPtr model = import.model();
  EXPECT_EQ(model->ngeom, 3);
  EXPECT_EQ(model->nmesh, 2);
  EXPECT_EQ(model->ntex, 1);
  EXPECT_EQ(model->njnt, 1);
  EXPECT_EQ(model->nu, 1);
  EXPECT_GE(mj_name2id(model.get(), mjOBJ_MESH, "crate"), 0);
  EXPECT_TRUE(std::filesystem::exists(import.folder / "site/meshes/crate_2.obj"));
  EXPECT_THAT(test::read_bytes(import.folder / "site/site.yaml"), HasSubstr("max_step_m"));
  EXPECT_THAT(import.assumption("ground"), HasSubstr("0.25 m"));
}

TEST(MjcfSite, BrokenModelsAreRefusedByOneLineAndNothingIsWritten) {
  EXPECT_EQ(SiteFileImport("a.xml", "<mujoco>\n<include file=\"b.xml\"/></mujoco>").error(),
            "a.xml:2: <include>: b.xml: file not found");
  EXPECT_EQ(SiteFileImport("a.xml", "<mujoco><asset>\n<mesh file=\"b.obj\"/></asset></mujoco>").error(),
            "a.xml:2: <mesh>: b.obj: file not found");
  EXPECT_EQ(SiteFileImport("a.xml", "<mujoco><asset>\n<model file=\"b.xml\"/></asset></mujoco>").error(),
            "a.xml:2: <model>: attached models are not supported");
  EXPECT_EQ(SiteFileImport("a.xml", "<robot name=\"r\"/>").error(), "a.xml:1: <robot>: must be <mujoco>");
  EXPECT_EQ(SiteFileImport("a.xml", "<mujoco>").error(), "a.xml:1: not XML: mismatched element: a tag is not closed");
  SiteFileImport refused("a.xml", "<mujoco><worldbody><geom type=\"box\" size=\"-1 1 1\"/></worldbody></mujoco>");
  EXPECT_THAT(refused.error(), HasSubstr("a.xml: MuJoCo refuses the site: "));
  EXPECT_FALSE(std::filesystem::exists(refused.folder / "site"));
}

}  // namespace
}  // namespace patrol::importer::mjcf_site_test
