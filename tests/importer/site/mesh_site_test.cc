#include "importer/site/mesh_site.h"

#include <cmath>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/error.h"
#include "core/geometry/angles.h"
#include "importer/site/texture_image.h"
#include "io/urdf.h"
#include "sim/lidar_scene.h"
#include "tests/importer/site/mesh_files.h"
#include "tests/support/pose_near.h"
#include "tests/support/simulated_wheeled_robot.h"

namespace patrol::importer::mesh_site_test {
namespace {

using test::VectorNear;
using ::testing::HasSubstr;

/// Room of 8 x 6 x 3 m seen from inside, and a crate of 1 m on its floor at x = 5 to 6, y = 2 to 3.
Mesh room_with_crate() {
  Mesh mesh;
  add_box(mesh, {0, 0, 0}, {8, 6, 3}, true);
  add_box(mesh, {5, 2, 0}, {6, 3, 1});
  return mesh;
}

/// Same points with y up, as in glTF.
Mesh y_up(const Mesh& mesh, double scale = 1.0) {
  Mesh turned = mesh;
  for (Eigen::Vector3d& v : turned.vertices_m) v = scale * Eigen::Vector3d(v.x(), v.z(), -v.y());
  return turned;
}

const SiteShape& seen(const ImportedSite& site, std::size_t i = 0) {
  for (const SiteShape& shape : site.shapes) {
    if (shape.use == ShapeUse::kSeen && i-- == 0) return shape;
  }
  throw std::runtime_error("no such shape");
}

Eigen::AlignedBox3d box_of_shape(const SiteShape& shape) {
  Eigen::AlignedBox3d box;
  for (const Eigen::Vector3d& v : shape.mesh.vertices_m) box.extend(v);
  return box;
}

TEST(MeshSite, AGltfRoomIsTurnedUprightWithItsTrianglesToAMicrometer) {
  SiteFileImport import("room.gltf", GltfText().of(y_up(room_with_crate())));
  const ImportedSite& site = import.read();
  EXPECT_EQ(seen(site).mesh.triangles.size(), 24U);
  EXPECT_THAT(box_of_shape(seen(site)).min(), VectorNear(Eigen::Vector3d(0, 0, 0), 1e-6));
  EXPECT_THAT(box_of_shape(seen(site)).max(), VectorNear(Eigen::Vector3d(8, 6, 3), 1e-6));
  EXPECT_NEAR(integrate(seen(site).mesh).volume_m3, -8.0 * 6.0 * 3.0 + 1.0, 1e-3);  // the room is seen from inside
  EXPECT_EQ(import.assumption("up axis"), "y, by the format");
  EXPECT_THAT(import.assumption("ground"), HasSubstr("a level plane at 0 m"));
}

TEST(MeshSite, LidarRangesInARoomAreThoseOfTheClosedFormToAMillimeter) {
  SiteFileImport import("room.gltf", GltfText().of(y_up(room_with_crate())));
  const sim::ModelPtr model = import.model();
  const sim::LidarScene scene(*model);
  const Eigen::Vector3d origin(2.0, 2.5, 0.5);
  const auto range = [&](const Eigen::Vector3d& direction) {
    const auto hit = scene.cast(origin, direction, 30.0, sim::kRayScenery);
    return hit ? hit->distance_m : -1.0;
  };
  EXPECT_NEAR(range({1, 0, 0}), 3.0, 1e-3);   // crate
  EXPECT_NEAR(range({-1, 0, 0}), 2.0, 1e-3);  // walls
  EXPECT_NEAR(range({0, 1, 0}), 3.5, 1e-3);
  EXPECT_NEAR(range({0, 0, 1}), 2.5, 1e-3);  // ceiling
  EXPECT_NEAR(range({0, 0, -1}), 0.5, 1e-3);
  for (int i = 0; i < 360; ++i) {
    const double angle = to_rad(i);
    const Eigen::Vector3d d(std::cos(angle), std::sin(angle), 0.0);
    const double to_x = d.x() > 0 ? 6.0 / d.x() : (d.x() < 0 ? -2.0 / d.x() : 1e9);
    const double to_y = d.y() > 0 ? 3.5 / d.y() : (d.y() < 0 ? -2.5 / d.y() : 1e9);
    double expected = std::min(to_x, to_y);
    if (d.x() > 0 && std::abs(3.0 / d.x() * d.y()) < 0.5) expected = 3.0 / d.x();
    EXPECT_NEAR(range(d), expected, 1e-3) << i;
  }
}

TEST(MeshSite, AWheeledRobotDrivesOverTheFloorAndIsStoppedByTheCrate) {
  SiteFileImport import("room.gltf", GltfText().of(y_up(room_with_crate())));
  import.model();
  std::string world = test::read_bytes(import.xml());
  const std::string relative = "file=\"meshes/", absolute = "file=\"" + (import.folder / "site/meshes/").string();
  for (std::size_t at = world.find(relative); at != std::string::npos; at = world.find(relative, at + absolute.size()))
    world.replace(at, relative.size(), absolute);
  sim::WheeledRobot robot(world, sim::wheeled_urdf_text(), {}, {}, {1.5, 4.5, 0.0});
  EXPECT_NEAR(robot.drive(0.5, 0.0, 8.0).moved.x, 4.0, 0.3);  // past the crate
  sim::WheeledRobot blocked(world, sim::wheeled_urdf_text(), {}, {}, {2.0, 2.5, 0.0});
  const double x = 2.0 + blocked.drive(0.5, 0.0, 10.0).moved.x;
  EXPECT_GT(x, 4.0);
  EXPECT_LT(x, 5.0);
}

TEST(MeshSite, AnEmbeddedTextureIsWrittenAsPngWithItsCoordinates) {
  Mesh floor;
  add_quad(floor, {0, 0, 0}, {4, 0, 0}, {4, 4, 0}, {0, 4, 0});
  TextureImage image{.width = 2, .height = 2, .rgb = {255, 0, 0, 0, 255, 0, 0, 0, 255, 255, 255, 255}};
  GltfText gltf;
  gltf.uv = {{0, 1}, {2, 1}, {2, -1}, {0, -1}};  // v downward
  gltf.material = R"({"name":"tiles","pbrMetallicRoughness":{"baseColorTexture":{"index":0}}})";
  gltf.more = fmt::format(R"(,"textures":[{{"source":0}}],"images":[{{"uri":"data:image/png;base64,{}"}}])",
                          GltfText::base64(encode_png(image)));
  SiteFileImport import("floor.gltf", gltf.of(y_up(floor)));
  const sim::ModelPtr model = import.model();
  ASSERT_EQ(import.site.files.size(), 1U);
  const auto decoded = decode_image(import.site.files[0].content, ".png");
  ASSERT_TRUE(decoded);
  EXPECT_EQ(decoded->rgb, image.rgb);
  EXPECT_EQ(import.site.materials[0].name, "tiles");
  EXPECT_EQ(import.site.materials[0].texture_length_m, 0.0);
  ASSERT_EQ(seen(import.site).texture_coordinates.size(), 4U);
  EXPECT_NEAR(seen(import.site).texture_coordinates[0].y(), 0.0, 1e-6);  // v upward
  EXPECT_NEAR(seen(import.site).texture_coordinates[2].y(), 2.0, 1e-6);
  EXPECT_EQ(model->nmeshtexcoord, 8);  // front and back
}

TEST(MeshSite, ATextureThatIsMissingBecomesTheColorOfTheMaterialWithARow) {
  Mesh floor;
  add_quad(floor, {0, 0, 0}, {4, 0, 0}, {4, 4, 0}, {0, 4, 0});
  GltfText gltf;
  gltf.uv = {{0, 0}, {1, 0}, {1, 1}, {0, 1}};
  gltf.material = R"({"pbrMetallicRoughness":{"baseColorFactor":[0.5,0.25,1,1],"baseColorTexture":{"index":0}}})";
  gltf.more = R"(,"textures":[{"source":0}],"images":[{"uri":"nothing.png"}])";
  SiteFileImport import("floor.gltf", gltf.of(y_up(floor)));
  import.model();
  EXPECT_THAT(import.assumption("texture nothing.png"), HasSubstr("file not found"));
  EXPECT_EQ(import.site.materials[0].texture, "");
  EXPECT_NEAR(import.site.materials[0].rgba[0], 0.735, 1e-3);  // 0.5 of linear light, as sRGB
}

/// 16 x 16 pixels of the color (200, 60, 40), by libjpeg at quality 90.
constexpr std::array<char, 288> kJpeg = {
    '\xff', '\xd8', '\xff', '\xe0', '\x00', '\x10', '\x4a', '\x46', '\x49', '\x46', '\x00', '\x01', '\x01', '\x00',
    '\x00', '\x01', '\x00', '\x01', '\x00', '\x00', '\xff', '\xdb', '\x00', '\x43', '\x00', '\x03', '\x02', '\x02',
    '\x03', '\x02', '\x02', '\x03', '\x03', '\x03', '\x03', '\x04', '\x03', '\x03', '\x04', '\x05', '\x08', '\x05',
    '\x05', '\x04', '\x04', '\x05', '\x0a', '\x07', '\x07', '\x06', '\x08', '\x0c', '\x0a', '\x0c', '\x0c', '\x0b',
    '\x0a', '\x0b', '\x0b', '\x0d', '\x0e', '\x12', '\x10', '\x0d', '\x0e', '\x11', '\x0e', '\x0b', '\x0b', '\x10',
    '\x16', '\x10', '\x11', '\x13', '\x14', '\x15', '\x15', '\x15', '\x0c', '\x0f', '\x17', '\x18', '\x16', '\x14',
    '\x18', '\x12', '\x14', '\x15', '\x14', '\xff', '\xdb', '\x00', '\x43', '\x01', '\x03', '\x04', '\x04', '\x05',
    '\x04', '\x05', '\x09', '\x05', '\x05', '\x09', '\x14', '\x0d', '\x0b', '\x0d', '\x14', '\x14', '\x14', '\x14',
    '\x14', '\x14', '\x14', '\x14', '\x14', '\x14', '\x14', '\x14', '\x14', '\x14', '\x14', '\x14', '\x14', '\x14',
    '\x14', '\x14', '\x14', '\x14', '\x14', '\x14', '\x14', '\x14', '\x14', '\x14', '\x14', '\x14', '\x14', '\x14',
    '\x14', '\x14', '\x14', '\x14', '\x14', '\x14', '\x14', '\x14', '\x14', '\x14', '\x14', '\x14', '\x14', '\x14',
    '\x14', '\x14', '\x14', '\x14', '\xff', '\xc0', '\x00', '\x11', '\x08', '\x00', '\x10', '\x00', '\x10', '\x03',
    '\x01', '\x22', '\x00', '\x02', '\x11', '\x01', '\x03', '\x11', '\x01', '\xff', '\xc4', '\x00', '\x15', '\x00',
    '\x01', '\x01', '\x00', '\x00', '\x00', '\x00', '\x00', '\x00', '\x00', '\x00', '\x00', '\x00', '\x00', '\x00',
    '\x00', '\x00', '\x00', '\x07', '\xff', '\xc4', '\x00', '\x14', '\x10', '\x01', '\x00', '\x00', '\x00', '\x00',
    '\x00', '\x00', '\x00', '\x00', '\x00', '\x00', '\x00', '\x00', '\x00', '\x00', '\x00', '\x00', '\xff', '\xc4',
    '\x00', '\x15', '\x01', '\x01', '\x01', '\x00', '\x00', '\x00', '\x00', '\x00', '\x00', '\x00', '\x00', '\x00',
    '\x00', '\x00', '\x00', '\x00', '\x00', '\x07', '\x08', '\xff', '\xc4', '\x00', '\x14', '\x11', '\x01', '\x00',
    '\x00', '\x00', '\x00', '\x00', '\x00', '\x00', '\x00', '\x00', '\x00', '\x00', '\x00', '\x00', '\x00', '\x00',
    '\x00', '\xff', '\xda', '\x00', '\x0c', '\x03', '\x01', '\x00', '\x02', '\x11', '\x03', '\x11', '\x00', '\x3f',
    '\x00', '\x9a', '\x00', '\x24', '\x58', '\x0f', '\xff', '\xd9'};

TEST(MeshSite, AJpegIsDecodedToItsColorsWithinItsLoss) {
  const auto image = decode_image({kJpeg.data(), kJpeg.size()}, ".jpg");
  ASSERT_TRUE(image);
  EXPECT_EQ(image->width, 16);
  EXPECT_THAT((255.0 * mean_color(*image)).eval(), VectorNear(Eigen::Vector3d(200, 60, 40), 3.0));
  EXPECT_EQ(decode_image({kJpeg.data(), kJpeg.size()}, ".jpg", 4)->width, 4);
  EXPECT_FALSE(decode_image("\xff\xd8\xff\xe0 no picture", ".jpg"));
  EXPECT_FALSE(decode_image("", ".png"));
  EXPECT_FALSE(decode_image("text", ".txt"));
}

TEST(MeshSite, UnitsAndTheUpAxisOfAnObjFollowTheRulesAndTheOptions) {
  const Mesh room = room_with_crate();
  SiteFileImport meters("room.obj", to_obj(room));
  EXPECT_THAT(box_of_shape(seen(meters.read())).max(), VectorNear(Eigen::Vector3d(8, 6, 3), 1e-5));
  EXPECT_THAT(meters.assumption("up axis"), ::testing::StartsWith("z: "));
  SiteFileImport millimeters("room.obj", to_obj(y_up(room, 1000.0)));
  EXPECT_THAT(box_of_shape(seen(millimeters.read())).max(), VectorNear(Eigen::Vector3d(8, 6, 3), 1e-4));
  EXPECT_THAT(millimeters.assumption("scale"), ::testing::StartsWith("0.001 m per unit"));
  EXPECT_THAT(millimeters.assumption("up axis"), ::testing::StartsWith("y: "));
  SiteFileImport centimeters("room.stl", "");
  test::write_bytes(centimeters.options.file.string() + ".obj", to_obj(scaled(room, {100, 100, 100})));
  centimeters.options.file = centimeters.options.file.string() + ".obj";
  centimeters.options.scale = 0.01;
  centimeters.options.up = "z";
  EXPECT_THAT(box_of_shape(seen(centimeters.read())).max(), VectorNear(Eigen::Vector3d(8, 6, 3), 1e-4));
  EXPECT_EQ(centimeters.assumption("scale"), "");
}

/// Collada file in centimeters with a quadrilateral.
std::string collada_floor(const std::string& up_axis, const std::string& corners) {
  return fmt::format(
      R"(<?xml version="1.0"?><COLLADA xmlns="http://www.collada.org/2005/11/COLLADASchema" version="1.4.1">
<asset><unit name="centimeter" meter="0.01"/><up_axis>{}</up_axis></asset>
<library_geometries><geometry id="g"><mesh><source id="p"><float_array id="a" count="12">{}</float_array><technique_common>
<accessor source="#a" count="4" stride="3"><param name="X" type="float"/><param name="Y" type="float"/><param name="Z" type="float"/></accessor>
</technique_common></source><vertices id="v"><input semantic="POSITION" source="#p"/></vertices>
<triangles count="2"><input semantic="VERTEX" source="#v" offset="0"/><p>0 1 2 0 2 3</p></triangles></mesh></geometry></library_geometries>
<library_visual_scenes><visual_scene id="s"><node><instance_geometry url="#g"/></node></visual_scene></library_visual_scenes>
<scene><instance_visual_scene url="#s"/></scene></COLLADA>)",
      up_axis, corners);
}

TEST(MeshSite, ColladaUnitsAndUpAxisAreThoseOfTheFile) {
  SiteFileImport z("floor.dae", collada_floor("Z_UP", "0 0 0 500 0 0 500 400 0 0 400 0"));
  EXPECT_THAT(box_of_shape(seen(z.read())).max(), VectorNear(Eigen::Vector3d(5, 4, 0), 1e-6));
  SiteFileImport y("floor.dae", collada_floor("Y_UP", "0 0 0 500 0 0 500 0 -400 0 0 -400"));
  EXPECT_THAT(box_of_shape(seen(y.read())).max(), VectorNear(Eigen::Vector3d(5, 4, 0), 1e-6));
}

TEST(MeshSite, TheScaleOptionReplacesTheUnitOfACollada) {
  SiteFileImport millimeters("floor.dae", collada_floor("Z_UP", "0 0 0 500 0 0 500 400 0 0 400 0"));
  millimeters.read();
  EXPECT_EQ(millimeters.assumption("scale"), "0.01 m per unit, by the format");
  millimeters.options.scale = 0.02;
  EXPECT_THAT(box_of_shape(seen(millimeters.read())).max(), VectorNear(Eigen::Vector3d(10, 8, 0), 1e-5));
}

TEST(MeshSite, UppercaseExtensionsAreKnown) {
  SiteFileImport gltf("room.GLTF", GltfText().of(y_up(room_with_crate())));
  EXPECT_THAT(box_of_shape(seen(gltf.read())).max(), VectorNear(Eigen::Vector3d(8, 6, 3), 1e-6));
  EXPECT_EQ(gltf.assumption("up axis"), "y, by the format");
  SiteFileImport dae("floor.DAE", collada_floor("Y_UP", "0 0 0 500 0 0 500 0 -400 0 0 -400"));
  EXPECT_THAT(box_of_shape(seen(dae.read())).max(), VectorNear(Eigen::Vector3d(5, 4, 0), 1e-6));
}

TEST(MeshSite, ARampIsGroundAtAllHeightsAndAPlaneNeedsNoRule) {
  Mesh ramp;
  add_quad(ramp, {0, 0, 0}, {8, 0, 3}, {8, 4, 3}, {0, 4, 0});
  SiteFileImport sloping("ramp.gltf", GltfText().of(y_up(ramp)));
  EXPECT_THAT(sloping.read().ground.all.geoms, ::testing::ElementsAre("contact_ground"));
  SiteFileImport level("room.gltf", GltfText().of(y_up(room_with_crate())));
  EXPECT_THAT(level.read().ground.all.geoms, ::testing::IsEmpty());
}

TEST(MeshSite, AMirroredNodeKeepsItsFrontsOutside) {
  Mesh box;
  add_box(box, {1, 0, 0}, {4, 3, 2});
  GltfText gltf;
  gltf.node = R"("mesh":0,"scale":[-1,1,1])";
  SiteFileImport import("box.gltf", gltf.of(y_up(box)));
  EXPECT_NEAR(integrate(seen(import.read()).mesh).volume_m3, 18.0, 1e-4);
  EXPECT_NEAR(box_of_shape(seen(import.site)).min().x(), -4.0, 1e-6);
}

TEST(MeshSite, LightsAndAnimationsAreRowsAndDegenerateTrianglesAreLeftOut) {
  Mesh room = room_with_crate();
  room.triangles.push_back({0, 0, 1});
  room.triangles.push_back({0, 1, 1});
  GltfText gltf;
  gltf.more =
      R"(,"extensionsUsed":["KHR_lights_punctual"],"extensions":{"KHR_lights_punctual":{"lights":[{"type":"point"}]}})";
  gltf.node = R"("mesh":0,"extensions":{"KHR_lights_punctual":{"light":0}})";
  SiteFileImport import("room.gltf", gltf.of(y_up(room)));
  import.model();
  EXPECT_EQ(import.assumption("extensionsUsed"), "KHR_lights_punctual: ignored");
  EXPECT_THAT(import.assumption("lights"), HasSubstr("1 in the file"));
  EXPECT_EQ(seen(import.site).mesh.triangles.size(), 24U);
}

TEST(MeshSite, BrokenFilesAreRefusedByOneLine) {
  const Mesh room = room_with_crate();
  Mesh bad = room;
  bad.vertices_m[3].x() = std::nan("");
  GltfText draco;
  draco.more = R"(,"extensionsRequired":["KHR_draco_mesh_compression"])";
  const std::string text = GltfText().of(room);
  EXPECT_EQ(SiteFileImport("a.gltf", draco.of(room)).error(),
            "a.gltf: extensionsRequired: KHR_draco_mesh_compression: this extension is not supported");
  EXPECT_EQ(SiteFileImport("a.gltf", GltfText().of(bad)).error(), "a.gltf: mesh has vertices that are not finite");
  EXPECT_THAT(SiteFileImport("a.gltf", text.substr(0, text.size() / 2)).error(),
              HasSubstr("a.gltf: not a glTF file: "));
  EXPECT_EQ(SiteFileImport("a.gltf", R"({"asset":{"version":"1.0"}})").error(),
            "a.gltf: asset.version: \"1.0\": must be 2.x");
  EXPECT_EQ(SiteFileImport("a.glb", "glTF").error(), "a.glb: GLB header: must be of version 2 with a JSON chunk");
  EXPECT_THAT(SiteFileImport("a.obj", "").error(), HasSubstr("a.obj: mesh cannot be read: "));
  EXPECT_THAT(SiteFileImport("a.stl", "solid x\nendsolid x\n").error(), HasSubstr("a.stl: "));
  EXPECT_EQ(SiteFileImport("a.ply", "ply\nformat ascii 1.0\nend_header\n").error(),
            "a.ply:3: the header contains no element");
  EXPECT_EQ(SiteFileImport("a.ply", "ply\nformat ascii 1.0\nelement vertex 4\n").error(),
            "a.ply:3: the header is incomplete");
  const std::string ply =
      "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float z\nelement face 1\n"
      "property list uchar int vertex_indices\nend_header\n0 0 0\n1 0 0\n0 1 0\n";
  EXPECT_EQ(SiteFileImport("a.ply", ply + "3 0 8 2\n").error(),
            "a.ply:13: vertex_indices: 8: must be one of the 3 vertices, from 0");
  EXPECT_EQ(SiteFileImport("a.dae", "<COLLADA>\n<p>0 . 2</p></COLLADA>").error(), "a.dae:2: <p>: must be integers");
  SiteFileImport absent("a.obj", "");
  absent.options.file = absent.folder / "b.obj";
  EXPECT_EQ(absent.error(), "b.obj: mesh file not found");
  EXPECT_EQ(SiteFileImport("a.fbx", "").error(),
            "a.fbx: extension of a site file must be one of .yaml, .mcap, .clf, .log, .gz, .gltf, .glb, .obj, .dae, "
            ".stl, .sdf, .world, .xml, "
            ".ply, .pcd, .las, .laz, .xyz, .pts, .asc, .csv, .txt, .e57, .sdf.xacro, .world.xacro; a folder must "
            "contain scans");
  SiteFileImport large("a.obj", to_obj(room));
  large.options.scale = 1e5;
  EXPECT_EQ(large.error(),
            "a.obj: coordinates up to 8e+05 m: must be at most 100000 m: move the origin of the file near the site");
  SiteFileImport start("a.obj", to_obj(room));
  start.options.mission.start = Pose2{50.0, 0.0, 0.0};
  EXPECT_EQ(start.error(), "a.obj: --start 50,0: no walkable surface there");
  EXPECT_FALSE(std::filesystem::exists(start.folder / "site"));
}

TEST(MeshSite, AMissingMaterialLibraryOfAnObjIsARow) {
  SiteFileImport import("room.obj", "mtllib none.mtl\n" + to_obj(room_with_crate()));
  import.read();
  EXPECT_THAT(import.assumption("mtllib none.mtl"), HasSubstr("file not found"));
}

TEST(MeshSite, VertexColorsOfAPlyBecomeMaterials) {
  std::string ply =
      "ply\nformat ascii 1.0\nelement vertex 6\nproperty float x\nproperty float y\nproperty float z\nproperty uchar "
      "red\n"
      "property uchar green\nproperty uchar blue\nelement face 2\nproperty list uchar int vertex_indices\nend_header\n"
      "0 0 0 255 0 0\n4 0 0 255 0 0\n4 4 0 255 0 0\n0 0 0 0 0 255\n4 4 0 0 0 255\n0 4 0 0 0 255\n3 0 1 2\n3 3 4 5\n";
  SiteFileImport import("floor.ply", ply);
  import.model();
  EXPECT_EQ(import.site.materials[0].name, "color 300");
  EXPECT_EQ(import.site.materials[1].name, "color 003");
  // Each has one triangle, split because MuJoCo requires four vertices.
  EXPECT_EQ(seen(import.site, 1).mesh.triangles.size(), 2U);
}

TEST(MeshSite, MoreTrianglesThanTheLimitAreRefused) {
  constexpr int kSide = 1001;
  std::string obj;
  for (int row = 0; row <= kSide; ++row) {
    for (int col = 0; col <= kSide; ++col) obj += fmt::format("v {} {} 0\n", col, row);
  }
  for (int row = 0; row < kSide; ++row) {
    for (int col = 0; col < kSide; ++col) {
      const int i = row * (kSide + 1) + col + 1;
      obj += fmt::format("f {} {} {} {}\n", i, i + 1, i + kSide + 2, i + kSide + 1);
    }
  }
  EXPECT_EQ(SiteFileImport("a.obj", obj).error(), "a.obj: 2004002 triangles: must be at most 2000000");
}

}  // namespace
}  // namespace patrol::importer::mesh_site_test
