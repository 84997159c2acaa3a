#include <numbers>
#include <string>

#include <Eigen/Geometry>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "importer/mesh.h"
#include "importer/site/sdf_site.h"
#include "tests/importer/site/mesh_files.h"
#include "tests/importer/site/sdf_text.h"
#include "tests/support/pose_near.h"
#include "tests/support/temporary_file.h"

namespace patrol::importer::sdf_shapes_test {
namespace {

using sdf_text::collision, sdf_text::kBox, sdf_text::model, sdf_text::shape_of, sdf_text::visual, sdf_text::world;
using test::VectorNear;

Eigen::AlignedBox3d extent_of(const Mesh& mesh) {
  Eigen::AlignedBox3d box;
  for (const Eigen::Vector3d& vertex : mesh.vertices_m) box.extend(vertex);
  return box;
}

TEST(SdfShapes, AConeIsAPyramidWithContact) {
  const std::string cone = "<cone><radius>0.5</radius><length>1.2</length></cone>";
  SiteFileImport import("a.sdf", world(model("c", visual(cone) + collision(cone), "3 0 0.6 0 0 0"), "1.12"));
  import.model();
  const Mesh& mesh = shape_of(import.site, "c.link.visual").mesh;
  EXPECT_TRUE(is_closed(welded(mesh)));
  EXPECT_NEAR(integrate(mesh).volume_m3, std::numbers::pi * 0.25 * 1.2 / 3.0, 0.01 * std::numbers::pi * 0.1);
  EXPECT_THAT(extent_of(mesh).max(), VectorNear(Eigen::Vector3d(0.5, 0.5, 0.6), 1e-9));
  EXPECT_THAT(shape_of(import.site, "c.link.visual").T_site_shape.position,
              VectorNear(Eigen::Vector3d(3, 0, 0.6), 1e-9));
  EXPECT_EQ(shape_of(import.site, "contact_hull_1").use, ShapeUse::kContactOnly);
  EXPECT_EQ(
      SiteFileImport("a.sdf", world(model("c", visual("<cone><radius>0</radius><length>1</length></cone>")))).error(),
      "a.sdf:3: <geometry>: <cone>: <radius> must be positive");
  EXPECT_EQ(SiteFileImport("a.sdf", world(model("c", visual("<cone><radius>1</radius></cone>")))).error(),
            "a.sdf:3: <geometry>: <cone>: <length> must be positive");
}

TEST(SdfShapes, TheScaleOfAStateIsThatOfGazebo) {
  const auto scaled_model = [](const std::string& geometry) {
    return world(
        model("m", "<pose>0 1 0 0 0 0</pose>" + visual(geometry)) +
        "<state world_name='w'><model name='m'><pose>5 0 0 0 0 0</pose><scale>2 3 0.5</scale></model></state>");
  };
  const auto size_m = [&](const std::string& geometry) -> Eigen::Vector3d {
    SiteFileImport import("a.sdf", scaled_model(geometry));
    import.read();
    EXPECT_EQ(import.assumption("<scale>"), "the state scales the shapes of 1 models, as in Gazebo");
    EXPECT_THAT(import.site.shapes.front().T_site_shape.position, VectorNear(Eigen::Vector3d(5, 1, 0), 1e-9));
    return import.site.shapes.front().size_m;
  };
  EXPECT_THAT(size_m(kBox), VectorNear(Eigen::Vector3d(1.0, 3.0, 0.75), 1e-12));
  EXPECT_THAT(size_m("<cylinder><radius>0.5</radius><length>2</length></cylinder>"),
              VectorNear(Eigen::Vector3d(1.5, 0.5, 0.0), 1e-12));
  EXPECT_THAT(size_m("<sphere><radius>0.5</radius></sphere>"), VectorNear(Eigen::Vector3d(1.5, 0.0, 0.0), 1e-12));
  // The scale of the state replaces that of a mesh.
  SiteFileImport import("a.sdf", scaled_model("<mesh><uri>box.obj</uri><scale>2 3 0.5</scale></mesh>"));
  Mesh box;
  add_box(box, {0, 0, 0}, {1, 1, 1});
  test::write_bytes(import.folder / "box.obj", to_obj(box));
  EXPECT_THAT(extent_of(import.read().shapes.front().mesh).max(), VectorNear(Eigen::Vector3d(2, 3, 0.5), 1e-6));
}

}  // namespace
}  // namespace patrol::importer::sdf_shapes_test
