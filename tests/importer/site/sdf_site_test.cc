#include "importer/site/sdf_site.h"

#include <unistd.h>

#include <filesystem>
#include <numbers>
#include <stdexcept>
#include <string>
#include <vector>

#include <Eigen/Core>
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "importer/mesh.h"
#include "sim/lidar_scene.h"
#include "tests/importer/site/mesh_files.h"
#include "tests/importer/site/sdf_text.h"
#include "tests/support/pose_near.h"
#include "tests/support/temporary_file.h"

namespace patrol::importer::sdf_site_test {
namespace {

using sdf_text::collision, sdf_text::kBox, sdf_text::link, sdf_text::model, sdf_text::shape_of, sdf_text::visual,
    sdf_text::world;
using test::VectorNear;
using ::testing::HasSubstr;

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

// The mesh is 3 m long and the start 12 m from it, beyond the part of the plane that the search for the ground sees.
TEST(SdfSite, AStartOnThePlaneFarFromAMeshIsAccepted) {
  Mesh fence;
  add_box(fence, {0, 0, 0}, {3, 0.1, 1});
  SiteFileImport import("a.sdf", world("<include><uri>model://ground_plane</uri></include>" +
                                       model("fence", collision("<mesh><uri>fence.obj</uri></mesh>"), "5 0 0 0 0 0")));
  test::write_bytes(import.folder / "fence.obj", to_obj(fence));
  import.options.mission.start = Pose2{-12.0, 0.0, 0.0};
  EXPECT_EQ(shape_of(import.read(), "contact_hull_1").type, SiteShapeType::kMesh);
}

TEST(SdfSite, AnEmptyFileIsRefusedWithoutALine) {
  EXPECT_EQ(SiteFileImport("a.sdf", "").error(), "a.sdf: not XML: empty document");
  EXPECT_EQ(SiteFileImport("a.dae", "").error(), "a.dae: not XML: empty document");
}

TEST(SdfSite, AWorldWithoutAFloorForRandomStationsIsRefusedWithItsFile) {
  SiteFileImport import("a.sdf", world(model("m", visual(kBox) + collision(kBox))));
  import.options.mission.num_random = 1;
  import.options.mission.clearance_m = 1.2;
  EXPECT_EQ(import.error(), "a.sdf: the site has no ground outside of solids");
}

TEST(SdfSite, IgnoredElementsAreRowsWithTheirNumbersAndLines) {
  SiteFileImport import(
      "a.sdf", world("<plugin name=\"a\" filename=\"a.so\"/>\n<plugin name=\"b\" filename=\"b.so\"/>\n<thing/>\n"
                     "<model name=\"m\"><link name=\"link\">" +
                     visual(kBox) + "</link></model>"));
  import.read();
  EXPECT_EQ(import.assumption("<plugin>"), "ignored (2, the first in line 3)");
  EXPECT_EQ(import.assumption("<thing>"), "ignored: not an element of the format (line 5)");
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

/// A broken world with its message.
struct Broken {
  std::string elements;
  std::string message;
};

TEST(SdfSite, BrokenAndUnsupportedWorldsAreRefusedByOneLine) {
  const std::string m = "<model name='m'><link name='l'>", end = "</link></model>";
  const auto shaped = [&](const std::string& geometry) { return m + visual(geometry) + end; };
  for (const Broken& broken : std::vector<Broken>{
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
           {shaped("<mesh><uri>absent.dae</uri></mesh>"),
            "a.sdf:3: <mesh>: absent.dae: file not found, also in the three folders above the file and above the "
            "world: "
            "put it there, or name a folder in GAZEBO_RESOURCE_PATH"},
           {shaped("<mesh><uri>https://host/a.dae</uri></mesh>"),
            "a.sdf:3: <mesh>: https://host/a.dae: files of a network are not supported"},
           {shaped("<polyline><height>1</height><point>0 0</point><point>2 2</point><point>2 0</point><point>0 "
                   "2</point></polyline>"),
            "a.sdf:3: <polyline>: must be a polygon without self-intersection"},
           {shaped(kBox) + "<state world_name='w'><model name='m'><scale>2 0 1</scale></model></state>",
            "a.sdf:3: <scale>: must be three positive numbers"},
           {shaped(kBox) + "<state world_name='w'><model name='m'><scale>1 1 2</scale></model></state>",
            "a.sdf:3: <scale>: needs the <pose> of the model beside it"},
           {"<state world_name='w'><insertions/></state>",
            "a.sdf:3: <insertions>: insertions of a state are not supported: write the models out"},
           {"", "a.sdf: the world has no geometry"},
       })
    EXPECT_EQ(SiteFileImport("a.sdf", world(broken.elements)).error(), broken.message);
  EXPECT_EQ(SiteFileImport("a.sdf", "<sdf version='1.7'>\n<world name='w'>\n</sdf>").error(),
            "a.sdf:2: not XML: mismatched element: a tag is not closed");
  EXPECT_EQ(SiteFileImport("a.sdf", "<sdf version='2.0'/>").error(),
            "a.sdf:1: <sdf>: version = \"2.0\": must be 1.3 to 1.12");
  EXPECT_EQ(SiteFileImport("a.sdf", "<sdf version='1.7'>\n<world name='w'/>\n<world name='v'/></sdf>").error(),
            "a.sdf:3: <world>: second world: must be one");
  EXPECT_EQ(SiteFileImport("a.sdf", "<sdf version='1.7'><model name='m'/></sdf>").error(),
            "a.sdf:1: <sdf>: has no <world>: import a world that includes the model");
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
