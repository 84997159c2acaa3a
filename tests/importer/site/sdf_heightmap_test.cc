#include <cstdint>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "importer/mesh.h"
#include "importer/site/texture_image.h"
#include "sim/lidar_scene.h"
#include "tests/importer/site/mesh_files.h"
#include "tests/importer/site/sdf_text.h"
#include "tests/support/temporary_file.h"

namespace patrol::importer::sdf_heightmap_test {
namespace {

using sdf_text::collision, sdf_text::model, sdf_text::visual, sdf_text::world;

TEST(SdfSite, AHeightmapHasTheHeightsOfItsPictureWithTheBrightestPixelAtItsSize) {
  SiteFileImport import(
      "a.sdf",
      world(model("t", visual("<heightmap><uri>h.png</uri><size>8 8 2.55</size><pos>0 0 1</pos></heightmap>"))));
  TextureImage image{.width = 3, .height = 3};
  for (int i = 0; i < 9; ++i) image.rgb.insert(image.rgb.end(), 3, static_cast<std::uint8_t>(20 * i));
  test::write_bytes(import.folder / "h.png", encode_png(image));
  const sim::ModelPtr compiled = import.model();
  const sim::LidarScene scene(*compiled);
  const auto down = scene.cast({0, 0, 10}, {0, 0, -1}, 30.0, sim::kRayScenery);
  ASSERT_TRUE(down);
  EXPECT_NEAR(10.0 - down->distance_m, 1.0 + 2.55 / 2, 1e-3);  // the middle pixel is 80, the brightest 160
  const auto corner = scene.cast({-3.999, 3.999, 10}, {0, 0, -1}, 30.0, sim::kRayScenery);
  ASSERT_TRUE(corner);
  EXPECT_NEAR(10.0 - corner->distance_m, 1.0, 1e-3);  // first pixel: 0, at -x and +y
}

TEST(SdfSite, AHeightmapThatIsVisualAndCollisionIsOneRowAndItsCollisionIsGround) {
  const std::string map = "<heightmap><uri>h.png</uri><size>8 8 2.55</size></heightmap>";
  SiteFileImport import("a.sdf", world(model("t", visual(map) + collision(map))));
  TextureImage image{.width = 3, .height = 3};
  for (int i = 0; i < 9; ++i) image.rgb.insert(image.rgb.end(), 3, static_cast<std::uint8_t>(20 * i));
  test::write_bytes(import.folder / "h.png", encode_png(image));
  import.read();
  int rows = 0;
  for (const Assumption& row : import.site.assumptions) rows += row.subject == "heightmap h.png" ? 1 : 0;
  EXPECT_EQ(rows, 1);
  EXPECT_THAT(import.site.ground.all.geoms, ::testing::ElementsAre("t.link.collision"));
}

TEST(SdfSite, ALevelHeightmapIsTheGroundOfAMeshThatFloats50CentimetersAboveIt) {
  Mesh slab;
  add_box(slab, {-1, -1, 1.5}, {1, 1, 1.7});
  SiteFileImport import("a.sdf",
                        world(model("t", collision("<heightmap><uri>h.png</uri><size>8 8 2.55</size><pos>0 0 1</pos>"
                                                   "</heightmap>")) +
                              model("slab", collision("<mesh><uri>slab.obj</uri></mesh>"))));
  TextureImage image{.width = 9, .height = 9};
  image.rgb.assign(3 * 81, 0);
  test::write_bytes(import.folder / "h.png", encode_png(image));
  test::write_bytes(import.folder / "slab.obj", to_obj(slab));
  import.read();
  EXPECT_EQ(import.assumption("ground"), "the surfaces with contact of their own");
  for (const SiteShape& shape : import.site.shapes) EXPECT_NE(shape.name, "contact_ground");
}

}  // namespace
}  // namespace patrol::importer::sdf_heightmap_test
