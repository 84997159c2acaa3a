#include "importer/site/sdf_site.h"

#include <unistd.h>

#include <cmath>
#include <filesystem>
#include <numbers>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/error.h"
#include "importer/site/texture_image.h"
#include "sim/lidar_scene.h"
#include "tests/importer/site/mesh_files.h"
#include "tests/support/pose_near.h"

namespace patrol::importer::sdf_site_test {
namespace {

using test::VectorNear;
using ::testing::HasSubstr;

/// World with the elements from line 3 on.
std::string world(const std::string& elements, const std::string& version = "1.7") {
  return fmt::format("<?xml version=\"1.0\"?>\n<sdf version=\"{}\"><world name=\"w\">\n{}\n</world></sdf>\n", version,
                     elements);
}

std::string model(const std::string& name, const std::string& link, const std::string& pose = "0 0 0 0 0 0") {
  return fmt::format("<model name=\"{}\"><static>true</static><pose>{}</pose><link name=\"link\">{}</link></model>\n",
                     name, pose, link);
}

std::string visual(const std::string& geometry, const std::string& more = "") {
  return fmt::format("<visual name=\"visual\"><geometry>{}</geometry>{}</visual>", geometry, more);
}

std::string collision(const std::string& geometry) {
  return fmt::format("<collision name=\"collision\"><geometry>{}</geometry></collision>", geometry);
}

const std::string kBox = "<box><size>1 2 3</size></box>";

const SiteShape& shape_of(const ImportedSite& site, const std::string& name) {
  for (const SiteShape& shape : site.shapes) {
    if (shape.name == name) return shape;
  }
  throw std::runtime_error("no shape " + name);
}

const SiteMaterial& material_of(const ImportedSite& site, const SiteShape& shape) {
  for (const SiteMaterial& material : site.materials) {
    if (material.name == shape.material) return material;
  }
  throw std::runtime_error("no material");
}

TEST(SdfSite, PrimitivesHaveTheirSizesUsesAndColors) {
  SiteFileImport import(
      "a.sdf",
      world(model("b", visual(kBox, "<material><diffuse>0.2 0.4 0.6 1</diffuse></material>") + collision(kBox)) +
            model("c", visual("<cylinder><radius>0.5</radius><length>2</length></cylinder>")) +
            model("s", visual("<sphere><radius>0.7</radius></sphere>")) +
            model("k", visual("<capsule><radius>0.2</radius><length>0.6</length></capsule>")) +
            model("e", visual("<ellipsoid><radii>1 2 3</radii></ellipsoid>")) +
            model("p", visual("<plane><normal>0 1 0</normal><size>4 6</size></plane>")) +
            model("n", visual("<empty/>"))));
  const sim::ModelPtr compiled = import.model();
  const ImportedSite& site = import.site;
  EXPECT_EQ(shape_of(site, "b.link.visual").use, ShapeUse::kSeen);
  EXPECT_EQ(shape_of(site, "b.link.collision").use, ShapeUse::kContactOnly);
  EXPECT_THAT(shape_of(site, "b.link.visual").size_m, VectorNear(Eigen::Vector3d(0.5, 1.0, 1.5), 1e-12));
  EXPECT_NEAR(material_of(site, shape_of(site, "b.link.visual")).rgba[2], 0.6, 1e-6);
  EXPECT_THAT(shape_of(site, "c.link.visual").size_m, VectorNear(Eigen::Vector3d(0.5, 1.0, 0.0), 1e-12));
  EXPECT_THAT(shape_of(site, "s.link.visual").size_m, VectorNear(Eigen::Vector3d(0.7, 0.0, 0.0), 1e-12));
  EXPECT_THAT(shape_of(site, "k.link.visual").size_m, VectorNear(Eigen::Vector3d(0.2, 0.3, 0.0), 1e-12));
  EXPECT_THAT(shape_of(site, "e.link.visual").size_m, VectorNear(Eigen::Vector3d(1.0, 2.0, 3.0), 1e-12));
  const SiteShape& plane = shape_of(site, "p.link.visual");
  EXPECT_THAT((plane.T_site_shape.rotation * Eigen::Vector3d::UnitZ()).eval(),
              VectorNear(Eigen::Vector3d::UnitY().eval(), 1e-12));
  EXPECT_EQ(compiled->ngeom, 7);
}

TEST(SdfSite, NestedModelsAndFramesArePlacedToAMicrometer) {
  SiteFileImport import("a.sdf", world(R"(<frame name="corner"><pose>2 1 0 0 0 1.5707963267948966</pose></frame>
<model name="m"><static>true</static><pose relative_to="corner">1 0 0.5 0 0 0</pose>
<link name="a"><pose>0 0 1 0 0 0</pose></link>
<frame name="f" attached_to="a"><pose>0 2 0 0 0 0</pose></frame>
<link name="link"><pose relative_to="f">0 0 0 0 0 0</pose>)" +
                                       visual(kBox) + R"(</link>
<model name="n"><pose>0 0 2 0 0 0</pose><link name="link"><pose>1 0 0 0 0 0</pose>)" +
                                       visual(kBox) + "</link></model></model>"));
  const ImportedSite& site = import.read();
  // Model at (2, 2, 0.5), turned by 90 degrees: its y points along -x of the world.
  EXPECT_THAT(shape_of(site, "m.link.visual").T_site_shape.position, VectorNear(Eigen::Vector3d(0, 2, 1.5), 1e-6));
  EXPECT_THAT(shape_of(site, "m.n.link.visual").T_site_shape.position, VectorNear(Eigen::Vector3d(2, 3, 2.5), 1e-6));
  EXPECT_NEAR(to_yaw(shape_of(site, "m.n.link.visual").T_site_shape.rotation), std::numbers::pi / 2, 1e-6);
}

TEST(SdfSite, GroundPlaneAndSunAreKnownWithoutAFolder) {
  SiteFileImport import(
      "a.world",
      world("<include><uri>model://ground_plane</uri></include>\n<include><uri>model://sun</uri></include>", "1.6"));
  const sim::ModelPtr compiled = import.model();
  EXPECT_EQ(compiled->ngeom, 2);
  EXPECT_THAT(import.assumption("model://ground_plane"), HasSubstr("the plane z = 0"));
  EXPECT_THAT(import.assumption("<light>"), HasSubstr("one sun"));
}

TEST(SdfSite, IncludedModelsAreFoundBesideTheFileAndByOption) {
  const std::string include =
      world("<include><uri>model://crate</uri><name>c2</name><pose>3 0 0 0 0 0</pose></include>");
  for (const bool is_beside : {true, false}) {
    SiteFileImport import("a.sdf", include);
    const std::filesystem::path folder = import.folder / (is_beside ? "models/crate" : "elsewhere/box");
    std::filesystem::create_directories(folder / "meshes");
    test::write_bytes(folder / "model.config", "<model><name>crate</name><sdf version=\"1.6\">model.sdf</sdf></model>");
    Mesh box;
    add_box(box, {-0.5, -0.5, 0}, {0.5, 0.5, 1});
    test::write_bytes(folder / "meshes/box.obj", to_obj(box));
    const std::string mesh = "<mesh><uri>model://crate/meshes/box.obj</uri><scale>2 1 1</scale></mesh>";
    test::write_bytes(folder / "model.sdf",
                      "<sdf version=\"1.6\">" +
                          model("crate", visual(mesh) + collision("<mesh><uri>meshes/box.obj</uri></mesh>")) +
                          "</sdf>");
    if (!is_beside) import.options.packages["crate"] = folder;
    const sim::ModelPtr compiled = import.model();
    Eigen::AlignedBox3d extent;
    for (const SiteShape& shape : import.site.shapes) {
      if (shape.use != ShapeUse::kSeen) continue;
      for (const Eigen::Vector3d& v : shape.mesh.vertices_m) extent.extend(shape.T_site_shape * v);
    }
    EXPECT_THAT(extent.min(), VectorNear(Eigen::Vector3d(2, -0.5, 0), 1e-6));
    EXPECT_THAT(extent.max(), VectorNear(Eigen::Vector3d(4, 0.5, 1), 1e-6));
  }
}

TEST(SdfSite, CollisionsWithoutVisualAreSeenByLidarsOnly) {
  SiteFileImport import("a.sdf", world(model("b", collision(kBox), "4 0 0 0 0 0")));
  const sim::ModelPtr compiled = import.model();
  EXPECT_EQ(shape_of(import.site, "b.link.collision.lidar").use, ShapeUse::kLidarOnly);
  const auto hit = sim::LidarScene(*compiled).cast({0, 0, 0}, {1, 0, 0}, 30.0, sim::kRayScenery);
  ASSERT_TRUE(hit);
  EXPECT_NEAR(hit->distance_m, 3.5, 1e-3);
}

TEST(SdfSite, APolylineIsAPrismAlsoWithAReentrantCorner) {
  SiteFileImport import(
      "a.sdf",
      world(model("l", visual("<polyline><height>2</height><point>0 0</point><point>2 0</point>"
                              "<point>2 1</point><point>1 1</point><point>1 2</point><point>0 2</point></polyline>"))));
  import.model();
  const Mesh& prism = shape_of(import.site, "l.link.visual").mesh;
  EXPECT_TRUE(is_closed(welded(prism)));
  EXPECT_NEAR(integrate(prism).volume_m3, 6.0, 1e-9);
}

TEST(SdfSite, AHeightmapHasTheHeightsOfItsPicture) {
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
  EXPECT_NEAR(10.0 - down->distance_m, 1.0 + 0.8, 1e-3);  // the middle pixel is 80
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

TEST(SdfSite, AMeshWithAnUppercaseGltfExtensionIsTurnedUpright) {
  Mesh box, turned;
  add_box(box, {0, 0, 0}, {1, 2, 3});
  turned = box;
  for (Eigen::Vector3d& v : turned.vertices_m) v = Eigen::Vector3d(v.x(), v.z(), -v.y());
  SiteFileImport import("a.sdf", world(model("m", visual("<mesh><uri>box.GLTF</uri></mesh>"))));
  test::write_bytes(import.folder / "box.GLTF", GltfText().of(turned));
  Eigen::AlignedBox3d extent;
  for (const Eigen::Vector3d& v : import.read().shapes.front().mesh.vertices_m) extent.extend(v);
  EXPECT_THAT(extent.max(), VectorNear(Eigen::Vector3d(1, 2, 3), 1e-6));
}

TEST(SdfSite, AnEmptyFileIsRefusedWithoutALine) {
  EXPECT_EQ(SiteFileImport("a.sdf", "").error(), "a.sdf: not XML: XML_ERROR_EMPTY_DOCUMENT");
  EXPECT_EQ(SiteFileImport("a.dae", "").error(), "a.dae: not XML: XML_ERROR_EMPTY_DOCUMENT");
}

TEST(SdfSite, AWorldWithoutAFloorForRandomStationsIsRefusedWithItsFile) {
  SiteFileImport import("a.sdf", world(model("m", visual(kBox) + collision(kBox))));
  import.options.mission.num_random = 1;
  import.options.mission.clearance_m = 1.2;
  EXPECT_EQ(import.error().substr(0, 68), "a.sdf: the plan has no free cell with a clearance of 1.2 m; the site");
}

TEST(SdfSite, IgnoredElementsAreRowsWithTheirNumbersAndLines) {
  SiteFileImport import(
      "a.sdf", world("<plugin name=\"a\" filename=\"a.so\"/>\n<plugin name=\"b\" filename=\"b.so\"/>\n<thing/>\n"
                     "<model name=\"m\"><link name=\"link\">" +
                     visual(kBox) + "</link></model>"));
  import.read();
  EXPECT_EQ(import.assumption("<plugin>"), "ignored (2, the first in line 3)");
  EXPECT_EQ(import.assumption("<thing>"), "ignored: not an element of the format");
  EXPECT_EQ(import.assumption("<model>"), "not static: made static at its initial pose (line 6)");
}

/// World of the benchmark BARN as Gazebo Classic writes it: cylinders, and a state with their poses.
std::string barn(int num_cylinders, double state_dx) {
  std::string models, states;
  const std::string cylinder = "<geometry><cylinder><radius>0.075</radius><length>1</length></cylinder></geometry>";
  const std::string contact =
      "<surface><contact><ode/></contact><bounce/><friction><torsional><ode/></torsional><ode/></friction></surface>";
  for (int i = 0; i < num_cylinders; ++i) {
    const std::string pose = fmt::format("{} {} 0.5 0 -0 0", -4.0 + 0.3 * (i % 10), 3.0 + 0.3 * (i / 10));
    models += fmt::format(
        "    <model name='unit_cylinder_{0}'>\n      <pose frame=''>{1}</pose>\n      <link name='link'>\n        "
        "<inertial>\n"
        "          <mass>1</mass>\n          "
        "<inertia><ixx>0.14</ixx><ixy>0</ixy><ixz>0</ixz><iyy>0.14</iyy><iyz>0</iyz><izz>0.12</izz></inertia>\n"
        "          <pose frame=''>0 0 0 0 -0 0</pose>\n        </inertial>\n        <collision "
        "name='collision'>{2}<max_contacts>10</max_contacts>{3}"
        "</collision>\n        <visual name='visual'>{2}<material><script><name>Gazebo/Grey</name>"
        "<uri>file://media/materials/scripts/gazebo.material</uri></script></material></visual>\n        "
        "<self_collide>0</self_collide>\n"
        "        <enable_wind>0</enable_wind>\n        <kinematic>0</kinematic>\n      </link>\n      "
        "<static>1</static>\n    </model>\n",
        i, pose, cylinder, contact);
    const std::string moved = fmt::format("{} {} 0.5 0 -0 0", -4.0 + 0.3 * (i % 10) + state_dx, 3.0 + 0.3 * (i / 10));
    states += fmt::format(
        "      <model name='unit_cylinder_{0}'><pose frame=''>{1}</pose><scale>1 1 1</scale><link name='link'><pose "
        "frame=''>{1}</pose>"
        "<velocity>0 0 0 0 -0 0</velocity><acceleration>0 0 -9.8 0 -0 0</acceleration><wrench>0 0 -9.8 0 -0 "
        "0</wrench></link></model>\n",
        i, moved);
  }
  return "<sdf version='1.6'>\n  <world name='default'>\n    <light name='sun' "
         "type='directional'><cast_shadows>1</cast_shadows>"
         "<pose frame=''>0 0 10 0 -0 0</pose><diffuse>0.8 0.8 0.8 1</diffuse><specular>0.2 0.2 0.2 1</specular>"
         "<attenuation><range>1000</range><constant>0.9</constant><linear>0.01</linear><quadratic>0.001</quadratic></"
         "attenuation>"
         "<direction>-0.5 0.1 -0.9</direction></light>\n    <model name='ground_plane'><static>1</static><link "
         "name='link'>"
         "<collision name='collision'><geometry><plane><normal>0 0 1</normal><size>100 100</size></plane></geometry>"
         "<surface><contact><collide_bitmask>65535</collide_bitmask><ode/></contact><friction><ode><mu>100</"
         "mu><mu2>50</mu2></ode>"
         "<torsional><ode/></torsional></friction><bounce/></surface><max_contacts>10</max_contacts></collision>"
         "<visual name='visual'><cast_shadows>0</cast_shadows><geometry><plane><normal>0 0 1</normal><size>100 "
         "100</size></plane></geometry>"
         "<material><script><uri>file://media/materials/scripts/gazebo.material</uri><name>Gazebo/Grey</name></"
         "script></material></visual>"
         "<self_collide>0</self_collide><enable_wind>0</enable_wind><kinematic>0</kinematic></link></model>\n"
         "    <gravity>0 0 -9.8</gravity>\n    <magnetic_field>6e-06 2.3e-05 -4.2e-05</magnetic_field>\n    "
         "<atmosphere type='adiabatic'/>\n"
         "    <physics name='default_physics' default='0' "
         "type='ode'><max_step_size>0.001</max_step_size><real_time_factor>1</real_time_factor>"
         "<real_time_update_rate>1000</real_time_update_rate></physics>\n    <scene><ambient>0.4 0.4 0.4 1</ambient>"
         "<background>0.7 0.7 0.7 1</background><shadows>1</shadows></scene>\n    <wind/>\n    <spherical_coordinates>"
         "<surface_model>EARTH_WGS84</surface_model><latitude_deg>0</latitude_deg><longitude_deg>0</"
         "longitude_deg><elevation>0</elevation>"
         "<heading_deg>0</heading_deg></spherical_coordinates>\n" +
         models +
         "    <state world_name='default'>\n      <sim_time>21 220000000</sim_time><real_time>21 "
         "4</real_time><wall_time>1580000000 1</wall_time>"
         "<iterations>21220</iterations>\n      <model name='ground_plane'><pose frame=''>0 0 0 0 -0 0</pose><scale>1 "
         "1 1</scale><link name='link'>"
         "<pose frame=''>0 0 0 0 -0 0</pose></link></model>\n" +
         states +
         "      <light name='sun'><pose frame=''>0 0 10 0 -0 0</pose></light>\n    </state>\n"
         "    <gui fullscreen='0'><camera name='user_camera'><pose frame=''>5 -5 2 0 0.27 "
         "2.35</pose><view_controller>orbit</view_controller>"
         "<projection_type>perspective</projection_type></camera></gui>\n  </world>\n</sdf>\n";
}

TEST(SdfSite, AWorldOfTheBenchmarkBarnLoadsUnchangedWithThePosesOfItsState) {
  SiteFileImport import("world_0.world", barn(200, 0.25));
  const sim::ModelPtr compiled = import.model();
  EXPECT_EQ(compiled->ngeom, 2 * 201);
  const SiteShape& first = shape_of(import.site, "unit_cylinder_0.link.collision");
  EXPECT_EQ(first.type, SiteShapeType::kCylinder);
  EXPECT_THAT(first.size_m, VectorNear(Eigen::Vector3d(0.075, 0.5, 0.0), 1e-12));
  EXPECT_THAT(first.T_site_shape.position, VectorNear(Eigen::Vector3d(-3.75, 3.0, 0.5), 1e-9));
  EXPECT_EQ(shape_of(import.site, "unit_cylinder_0.link.visual").material, "Gazebo/Grey");
  EXPECT_EQ(import.assumption("<state>"), "replaces the poses of 201 models");
  const auto hit = sim::LidarScene(*compiled).cast({-3.75, 0, 0.3}, {0, 1, 0}, 30.0, sim::kRayScenery);
  ASSERT_TRUE(hit);
  EXPECT_NEAR(hit->distance_m, 3.0 - 0.075, 1e-3);
}

TEST(SdfSite, ALinkWithoutStateMovesWithItsModel) {
  SiteFileImport import("a.sdf",
                        world(model("m", "<pose>0 1 0 0 0 0</pose>" + visual(kBox)) +
                              "<state world_name='w'><model name='m'><pose>5 0 0 0 0 0</pose></model></state>"));
  EXPECT_THAT(shape_of(import.read(), "m.link.visual").T_site_shape.position,
              VectorNear(Eigen::Vector3d(5, 1, 0), 1e-9));
}

TEST(SdfSite, ARoomAsMeshCollisionHasAnOpenInside) {
  Mesh room;
  add_box(room, {0, 0, 0}, {6, 6, 2.8}, true);
  SiteFileImport import(
      "a.sdf",
      world("<include><uri>model://ground_plane</uri></include>\n" +
            model("room", visual("<mesh><uri>room.obj</uri></mesh>") + collision("<mesh><uri>room.obj</uri></mesh>"),
                  "1 1 0 0 0 0")));
  test::write_bytes(import.folder / "room.obj", to_obj(room));
  import.model();
  int boxes = 0;
  for (const SiteShape& shape : import.site.shapes) {
    if (shape.use != ShapeUse::kContactOnly || shape.type != SiteShapeType::kBox) continue;
    ++boxes;
    const Eigen::Vector3d lower = shape.T_site_shape.position - shape.size_m,
                          upper = shape.T_site_shape.position + shape.size_m;
    const bool is_outside = lower.x() > 6.85 || lower.y() > 6.85 || upper.x() < 1.15 || upper.y() < 1.15;
    EXPECT_TRUE(is_outside) << shape.name;
  }
  EXPECT_GE(boxes, 4);
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

int num_temporary_folders() {
  int count = 0;
  const std::string prefix = fmt::format("patrol_sdf_{}_", ::getpid());
  for (const auto& entry : std::filesystem::directory_iterator(std::filesystem::temp_directory_path()))
    count += entry.path().filename().string().starts_with(prefix) ? 1 : 0;
  return count;
}

TEST(SdfSite, NeitherAReadNorARefusedWorldLeavesATemporaryFolder) {
  const std::string sun = "<include><uri>model://sun</uri></include>\n";
  SiteFileImport good("a.sdf", world(sun + model("b", visual(kBox))));
  good.read();
  SiteFileImport broken("b.sdf", world(sun + "<include><uri>model://absent</uri></include>"));
  EXPECT_THAT(broken.error(), HasSubstr("unknown model \"absent\""));
  EXPECT_EQ(num_temporary_folders(), 0);
}

TEST(SdfSite, ModelsAreFoundInBothVariablesOfGazeboAndTheOptionComesFirst) {
  SiteFileImport import("a.sdf", world("<include><uri>model://crate</uri></include>"));
  const auto write_crate = [&](const std::string& folder, const std::string& size_m) {
    std::filesystem::create_directories(import.folder / folder / "crate");
    test::write_bytes(import.folder / folder / "crate/model.config",
                      "<model><name>crate</name><sdf version=\"1.6\">model.sdf</sdf></model>");
    test::write_bytes(import.folder / folder / "crate/model.sdf",
                      "<sdf version=\"1.6\">" +
                          model("crate", visual("<sphere><radius>" + size_m + "</radius></sphere>")) + "</sdf>");
    return (import.folder / folder).string();
  };
  const auto radius_m = [&] {
    import.read();
    return import.site.shapes.front().size_m.x();
  };
  EXPECT_THAT(import.error(), HasSubstr("unknown model \"crate\""));
  for (const char* variable : {"GAZEBO_MODEL_PATH", "GZ_SIM_RESOURCE_PATH"}) {
    ::setenv(variable, ("/nowhere::" + write_crate("first", "0.5") + ":" + write_crate("second", "0.7")).c_str(), 1);
    EXPECT_EQ(radius_m(), 0.5) << variable;
    ::unsetenv(variable);
  }
  ::setenv("GAZEBO_MODEL_PATH", (import.folder / "first").c_str(), 1);
  import.options.packages["crate"] = write_crate("given", "0.9") + "/crate";
  EXPECT_EQ(radius_m(), 0.9);
  ::unsetenv("GAZEBO_MODEL_PATH");
}

/// A broken world with its message.
struct Broken {
  std::string elements;
  std::string message;
};

TEST(SdfSite, BrokenAndUnsupportedWorldsAreRefusedByOneLine) {
  const std::string m = "<model name='m'><link name='l'>", end = "</link></model>";
  const auto shaped = [&](const std::string& geometry) { return m + visual(geometry) + end; };
  for (const Broken& broken : std::vector<Broken>{
           {"<actor name='a'/>",
            "a.sdf:3: <actor>: animated actors are not supported: add pedestrians to the scenario"},
           {"<road name='r'/>", "a.sdf:3: <road>: roads are not supported: use a mesh or boxes"},
           {"<population name='p'/>", "a.sdf:3: <population>: populations are not supported: write the models out"},
           {shaped("<image><uri>a.png</uri></image>"),
            "a.sdf:3: <image>: extruded images are not supported: use a mesh or a floor plan"},
           {shaped("<torus/>"), "a.sdf:3: <torus>: is not a geometry of the format"},
           {"\n<gravity>0 0 -1.6</gravity>", "a.sdf:4: <gravity>: must be that of the earth, 0 0 -9.8"},
           {shaped("<box><size>-1 1 1</size></box>"), "a.sdf:3: <box>: size = -1: must be positive"},
           {shaped("<box><size>a 1 1</size></box>"), "a.sdf:3: <size>: \"a 1 1\" is not a valid value"},
           {"<model name='m'><pose>nan 0 0 0 0 0</pose><link name='l'/></model>",
            "a.sdf:3: <pose>: \"nan 0 0 0 0 0\" is not a valid value"},
           {"<model name='m'/>", "a.sdf:3: <model>: A model must have at least one link."},
           {"<model name='m'><pose relative_to='x'>0 0 0 0 0 0</pose><link name='l'/></model>",
            "a.sdf:3: relative_to name[x] specified by model with name[m] does not match a model or frame name in "
            "world with name[w]."},
           {m + end + "\n" + m + end, "a.sdf:4: model with name[m] already exists."},
           {"<include><uri>model://nowhere</uri></include>",
            "a.sdf:3: <include>: unknown model \"nowhere\": give its folder with --package nowhere=FOLDER, or the "
            "folder above it in "
            "GAZEBO_MODEL_PATH or GZ_SIM_RESOURCE_PATH"},
           {shaped("<mesh><uri>model://nowhere/a.dae</uri></mesh>"),
            "a.sdf:3: <mesh>: unknown model \"nowhere\": give its folder with --package nowhere=FOLDER, or the folder "
            "above it in "
            "GAZEBO_MODEL_PATH or GZ_SIM_RESOURCE_PATH"},
           {shaped("<mesh><uri>absent.dae</uri></mesh>"), "a.sdf:3: <mesh>: absent.dae: file not found"},
           {shaped("<mesh><uri>https://host/a.dae</uri></mesh>"),
            "a.sdf:3: <mesh>: https://host/a.dae: files of a network are not supported"},
           {shaped("<polyline><height>1</height><point>0 0</point><point>2 2</point><point>2 0</point><point>0 "
                   "2</point></polyline>"),
            "a.sdf:3: <polyline>: must be a polygon without self-intersection"},
           {shaped(kBox) +
                "<state world_name='w'><model name='m'><pose>0 0 0 0 0 0</pose><scale>2 1 1</scale></model></state>",
            "a.sdf:3: <scale>: scales of a state are not supported: scale the geometry"},
           {"<state world_name='w'><insertions/></state>",
            "a.sdf:3: <insertions>: insertions of a state are not supported: write the models out"},
           {"", "a.sdf: the world has no geometry"},
       })
    EXPECT_EQ(SiteFileImport("a.sdf", world(broken.elements)).error(), broken.message);
  EXPECT_THAT(
      SiteFileImport("a.sdf", world("<include><uri>https://fuel.gazebosim.org/1.0/o/models/A</uri></include>")).error(),
      ::testing::StartsWith("a.sdf:3: models of a network are not supported: "));
  EXPECT_EQ(SiteFileImport("a.sdf", "<sdf version='1.7'>\n<world name='w'>\n</sdf>").error(),
            "a.sdf:2: not XML: XML_ERROR_MISMATCHED_ELEMENT");
  EXPECT_EQ(SiteFileImport("a.sdf", "<sdf version='2.0'/>").error(),
            "a.sdf:1: <sdf>: version = \"2.0\": must be 1.0 to 1.12");
  EXPECT_EQ(SiteFileImport("a.sdf", "<sdf version='1.7'>\n<world name='w'/>\n<world name='v'/></sdf>").error(),
            "a.sdf:3: <world>: second world: must be one");
  EXPECT_EQ(SiteFileImport("a.sdf", "<sdf version='1.7'><model name='m'/></sdf>").error(),
            "a.sdf:1: <sdf>: has no <world>: import a world that includes the model");
}

/// Writes the model `name` beside the world, with its elements from line 2 on.
void write_model(const SiteFileImport& import, const std::string& name, const std::string& elements,
                 const std::string& version = "1.8") {
  const std::filesystem::path folder = import.folder / ("models/" + name);
  std::filesystem::create_directories(folder);
  test::write_bytes(folder / "model.config",
                    fmt::format("<model><name>{}</name><sdf version=\"{}\">model.sdf</sdf></model>", name, version));
  test::write_bytes(folder / "model.sdf",
                    fmt::format("<sdf version=\"{}\"><model name=\"{}\"><static>1</static>\n{}\n</model></sdf>",
                                version, name, elements));
}

std::string include(const std::string& name, const std::string& more = "") {
  return fmt::format("<include><uri>model://{}</uri>{}</include>", name, more);
}

std::string link(const std::string& shapes) { return "<link name=\"link\">" + shapes + "</link>"; }

TEST(SdfSite, ModelsThatIncludedModelsIncludeAreImportedWithTheirNamesAndPoses) {
  SiteFileImport import("a.sdf", world(include("hall", "<name>h</name><pose>10 0 0 0 0 1.5707963267948966</pose>")));
  write_model(import, "hall",
              "<frame name=\"f\"><pose>1 0 0 0 0 0</pose></frame>" + link(visual(kBox)) +
                  include("shelf", "<name>s1</name><pose relative_to=\"f\">2 0 0 0 0 0</pose>") +
                  include("shelf", "<name>s2</name><pose>0 0 5 0 0 0</pose>"));
  write_model(import, "shelf",
              link(visual(kBox)) + "<include>\n<uri>\n model://cup </uri><pose>0 1 0 0 0 0</pose></include>", "1.6");
  write_model(import, "cup", link(visual("<sphere><radius>0.1</radius></sphere>")));
  const ImportedSite& site = import.read();
  EXPECT_EQ(site.shapes.size(), 5u);
  EXPECT_THAT(shape_of(site, "h.s1.link.visual").T_site_shape.position, VectorNear(Eigen::Vector3d(10, 3, 0), 1e-6));
  EXPECT_THAT(shape_of(site, "h.s2.link.visual").T_site_shape.position, VectorNear(Eigen::Vector3d(10, 0, 5), 1e-6));
  EXPECT_THAT(shape_of(site, "h.s1.cup.link.visual").T_site_shape.position, VectorNear(Eigen::Vector3d(9, 3, 0), 1e-6));
}

TEST(SdfSite, AModelThatIncludesItselfAndOneThatIsNotFoundAreRefusedWithTheirFile) {
  SiteFileImport import("a.sdf", world(include("hall")));
  write_model(import, "hall", link("") + include("shelf"));
  write_model(import, "shelf", link("") + "\n" + include("hall"));
  EXPECT_EQ(import.error(), "models/shelf/model.sdf:3: <include>: \"model://hall\": the model includes itself");
  write_model(import, "shelf", link("") + "\n" + include("absent"));
  EXPECT_THAT(import.error(), ::testing::StartsWith("models/shelf/model.sdf:3: <include>: unknown model \"absent\": "));
  write_model(import, "shelf", link("") + "\n<include><uri/></include>");
  EXPECT_EQ(import.error(), "models/shelf/model.sdf:3: <uri>: is empty");
}

TEST(SdfSite, ErrorsOfIncludedModelsHaveTheirFileAndLine) {
  const std::string file = "models/crate/model.sdf:3: ";
  for (const bool is_nested : {false, true}) {
    SiteFileImport import("a.sdf", world(include(is_nested ? "hall" : "crate")));
    write_model(import, "hall", link("") + include("crate"));
    const auto error_of = [&](const std::string& elements) {
      write_model(import, "crate", elements);
      return import.error();
    };
    EXPECT_EQ(error_of("\n" + link(visual("<box><size>1 x 1</size></box>"))),
              file + "<size>: \"1 x 1\" is not a valid value");
    EXPECT_EQ(error_of("\n" + link(visual("<torus/>"))), file + "<torus>: is not a geometry of the format");
    EXPECT_EQ(error_of("\n<link>"), file + "not XML: XML_ERROR_MISMATCHED_ELEMENT");
    EXPECT_EQ(error_of(link("") + "\n" + link("")), file + "link with name[link] already exists.");
    EXPECT_EQ(error_of(link("") + "\n<frame name='f' attached_to='g'/><frame name='g' attached_to='f'/>"),
              file + "<frame>: \"f\": attached_to: cycle of frames: must lead to a link, a model or the world");
  }
}

TEST(SdfSite, CyclesOfFramesAreRefusedWithTheirLine) {
  const std::string text = ": cycle of frames: must lead to a link, a model or the world";
  EXPECT_EQ(SiteFileImport("a.sdf", world("<frame name='a' attached_to='b'/>\n<frame name='b' attached_to='a'/>\n" +
                                          model("m", visual(kBox))))
                .error(),
            "a.sdf:3: <frame>: \"a\": attached_to" + text);
  EXPECT_EQ(SiteFileImport("a.sdf", world("<frame name='a'><pose relative_to='b'/></frame>\n"
                                          "<frame name='b'><pose relative_to='a'/></frame>\n" +
                                          model("m", visual(kBox))))
                .error(),
            "a.sdf:3: <frame>: \"a\": relative_to" + text);
}

TEST(SdfSite, AWorldOfVersion111WithAModelOfVersion110AndARelativeMeshIsImported) {
  SiteFileImport import("a.sdf", world(include("crate", "<pose>3 0 0 0 0 0</pose>"), "1.11"));
  write_model(import, "crate",
              "<link name=\"link\"><inertial auto=\"true\"><density>500</density></inertial>" +
                  visual("<mesh optimization=\"convex_hull\"><uri>meshes/box.obj</uri></mesh>") + "</link>",
              "1.10");
  Mesh box;
  add_box(box, {-0.5, -0.5, 0}, {0.5, 0.5, 1});
  std::filesystem::create_directories(import.folder / "models/crate/meshes");
  test::write_bytes(import.folder / "models/crate/meshes/box.obj", to_obj(box));
  const SiteShape& shape = shape_of(import.read(), "crate.link.visual_1");
  EXPECT_EQ(shape.mesh.triangles.size(), 12u);
  EXPECT_THAT(shape.T_site_shape.position, VectorNear(Eigen::Vector3d(3, 0, 0), 1e-9));
  EXPECT_EQ(
      SiteFileImport("a.sdf", world(model("m", visual("<cone><radius>1</radius><length>1</length></cone>")), "1.12"))
          .error(),
      "a.sdf:3: <cone>: cones are not supported: use a mesh");
  EXPECT_EQ(SiteFileImport("a.sdf", world(model("m", visual(kBox)), "1.13")).error(),
            "a.sdf:2: <sdf>: version = \"1.13\": must be 1.0 to 1.12");
}

TEST(SdfSite, LinesOfErrorsAreThoseOfTheFileBehindCommentsAndTextOfSeveralLines) {
  EXPECT_EQ(SiteFileImport("a.sdf", world("<!-- a\n -->\n<model\n name='m'><static>\n1\n</static>" +
                                          link(visual("<box><size>1\n1\n1</size></box>")) +
                                          "\n\n<pose>x 0 0 0 0 0</pose></model>"))
                .error(),
            "a.sdf:12: <pose>: \"x 0 0 0 0 0\" is not a valid value");
}

TEST(SdfSite, AFileNamedLikeOneOfTheLibraryIsReadItself) {
  SiteFileImport import("joint.sdf", world(model("m", visual(kBox))));
  EXPECT_EQ(import.error(), "accepted");
}

}  // namespace
}  // namespace patrol::importer::sdf_site_test
