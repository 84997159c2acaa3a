#include <cmath>
#include <filesystem>
#include <string>
#include <vector>

#include <Eigen/Core>
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/importer/robot/description.h"
#include "tests/importer/robot/import.h"
#include "tests/importer/site/mesh_files.h"
#include "tests/support/temporary_file.h"

namespace patrol::importer::mesh_import_test {
namespace {

using test::write_bytes;
using ::testing::HasSubstr, ::testing::Not;

std::string mesh_wheel(const std::string& name, const std::string& xyz, const std::string& mesh) {
  return joint(name + "_joint", "continuous", "base_link", name, xyz, axis("0 1 0") + kMotor) +
         link(name, inertial(1.0) + shape("visual", mesh) + shape("collision", mesh));
}

TEST(ImportRobot, WheelsOfScaledMeshesAreMeasured) {
  const std::string mesh =
      R"(<mesh filename="package://vendor_description/meshes/wheel.stl" scale="0.001 0.001 0.001"/>)";
  Import import(
      robot(chassis() + mesh_wheel("l", "0 0.25 -0.05", mesh) + mesh_wheel("r", "0 -0.25 -0.05", mesh) + caster()));
  std::filesystem::create_directories(import.folder / "pkg/meshes");
  write_bytes(import.folder / "pkg/meshes/wheel.stl", stl(wheel_triangles(100.0, 40.0)));
  import.options.packages["vendor_description"] = import.folder / "pkg";
  import.load();
  expect_wheel(import, "l", {0.0, 0.25, -0.05}, 0.1, 0.04, 1e-5);
  ASSERT_EQ(import.robot.meshes.size(), 1U) << "one file for both wheels";
  EXPECT_TRUE(std::filesystem::exists(import.folder / "imported/meshes" / import.robot.meshes[0].first));
}

/// Wheel of glTF about z, which its node turns about x.
std::string gltf_wheel(double radius_m, double width_m, const std::string& more) {
  Mesh mesh;
  for (const Triangle& triangle : wheel_triangles(radius_m, width_m)) {
    const int first = static_cast<int>(mesh.vertices_m.size());
    for (const Eigen::Vector3d& v : triangle) mesh.vertices_m.emplace_back(v.x(), -v.z(), v.y());
    mesh.triangles.push_back({first, first + 1, first + 2});
  }
  GltfText text;
  text.node = R"("mesh":0,"rotation":[0.7071067811865476,0,0,0.7071067811865476],"translation":[0,-0.01,0])";
  text.material = R"({"name":"rubber","pbrMetallicRoughness":{"baseColorFactor":[0.2,0.4,0.6,1]}})";
  text.more = more;
  return text.of(mesh);
}

// As in RViz, the up axis y of the format is not applied: coordinates are those of the link.
TEST(ImportRobot, MeshesOfGltfHaveTheTransformsOfTheirNodesAndTheirColor) {
  const std::string mesh = R"(<mesh filename="wheel.gltf"/>)";
  Import import(
      robot(chassis() + mesh_wheel("l", "0 0.25 -0.05", mesh) + mesh_wheel("r", "0 -0.25 -0.05", mesh) + caster()));
  write_bytes(import.folder / "wheel.gltf", gltf_wheel(0.1, 0.04, ""));
  import.load();
  expect_wheel(import, "l", {0.0, 0.24, -0.05}, 0.1, 0.04, 1e-5);
  EXPECT_THAT(test::read_bytes(import.folder / "imported/imported.urdf"), HasSubstr("rgba=\"0.2 0.4 0.6 1\""));
  write_bytes(import.folder / "wheel.gltf",
              gltf_wheel(0.1, 0.04, R"(,"extensionsRequired":["KHR_draco_mesh_compression"])"));
  EXPECT_THAT(complaint(import), HasSubstr("KHR_draco_mesh_compression: this extension is not supported"));
}

TEST(ImportRobot, TheHubOfAWheelMeshDoesNotChangeItsWidthAndCenter) {
  std::vector<Triangle> triangles = wheel_triangles(0.1, 0.03);
  for (Triangle hub : wheel_triangles(0.04, 0.08)) {
    for (Eigen::Vector3d& corner : hub) corner.y() -= 0.055;
    triangles.push_back(hub);
  }
  const std::string mesh = R"(<mesh filename="wheel.stl"/>)";
  Import import(
      robot(chassis() + mesh_wheel("l", "0 0.25 -0.05", mesh) + mesh_wheel("r", "0 -0.25 -0.05", mesh) + caster()));
  write_bytes(import.folder / "wheel.stl", stl(triangles));
  import.load();
  expect_wheel(import, "l", {0.0, 0.25, -0.05}, 0.1, 0.03, 1e-5);
  expect_wheel(import, "r", {0.0, -0.25, -0.05}, 0.1, 0.03, 1e-5);
}

TEST(ImportRobot, AWheelMeshWithoutAFlatTreadIsAsWideAsItsSurfaceNearTheRadius) {
  std::vector<Triangle> triangles;  // a double cone, 0.2 m wide at the axle
  constexpr int kNumSides = 64;
  for (int i = 0; i < kNumSides; ++i) {
    const auto rim = [](int k) {
      const double angle = 2.0 * M_PI * k / kNumSides;
      return Eigen::Vector3d(0.1 * std::sin(angle), 0.0, 0.1 * std::cos(angle));
    };
    triangles.push_back({rim(i), rim(i + 1), Eigen::Vector3d(0.0, 0.1, 0.0)});
    triangles.push_back({rim(i + 1), rim(i), Eigen::Vector3d(0.0, -0.1, 0.0)});
  }
  const std::string mesh = R"(<mesh filename="wheel.stl"/>)";
  Import import(
      robot(chassis() + mesh_wheel("l", "0 0.25 -0.05", mesh) + mesh_wheel("r", "0 -0.25 -0.05", mesh) + caster()));
  write_bytes(import.folder / "wheel.stl", stl(triangles));
  import.load();
  expect_wheel(import, "l", {0.0, 0.25, -0.05}, 0.1, 0.02, 1e-5);
}

TEST(ImportRobot, PackagesAreFoundAboveTheFileByFolderAndByPackageXml) {
  const std::string mesh = R"(<mesh filename="package://{}/meshes/wheel.stl"/>)";
  for (const char* package : {"robot_meshes", "other_name"}) {
    const std::string text = fmt::format(fmt::runtime(mesh), package);
    Import import(
        robot(chassis() + mesh_wheel("l", "0 0.25 -0.05", text) + mesh_wheel("r", "0 -0.25 -0.05", text) + caster()));
    const auto folder = import.folder / "robot_meshes";
    std::filesystem::create_directories(folder / "meshes");
    std::filesystem::create_directories(folder / "urdf");
    write_bytes(folder / "package.xml", "<package><name>other_name</name></package>");
    write_bytes(folder / "meshes/wheel.stl", stl(wheel_triangles(0.1, 0.04)));
    std::filesystem::rename(import.options.file, folder / "urdf/vendor.urdf");
    import.options.file = folder / "urdf/vendor.urdf";
    import.load();
    expect_wheel(import, "l", {0.0, 0.25, -0.05}, 0.1, 0.04, 1e-5);
  }
}

TEST(ImportRobot, MeshesInMillimetersWithoutScaleAreScaledWithAnAssumption) {
  const std::string mesh = R"(<mesh filename="wheel.stl"/>)", body = R"(<mesh filename="body.stl"/>)";
  Import import(
      robot(link("base_link", inertial(20.0, "0 0 0", 0.5) + shape("visual", body) + shape("collision", body)) +
            mesh_wheel("l", "0 0.25 -0.05", mesh) + mesh_wheel("r", "0 -0.25 -0.05", mesh) + caster()));
  write_bytes(import.folder / "wheel.stl", stl(wheel_triangles(100.0, 40.0)));
  write_bytes(import.folder / "body.stl", stl(box_triangles({600.0, 400.0, 200.0})));
  import.load();
  expect_wheel(import, "r", {0.0, -0.25, -0.05}, 0.1, 0.04, 1e-5);
  EXPECT_THAT(import.assumptions(), HasSubstr("| meshes *.stl | are in millimeters"));
  EXPECT_THAT(
      import.robot.urdf,
      HasSubstr(R"(<collision><origin xyz="0 0 0" rpy="0 0 0"/><geometry><mesh filename="meshes/body_hull.obj"/>)"));
  EXPECT_THAT(import.assumptions(), HasSubstr("collision mesh body is replaced by 1 convex piece,"));
}

TEST(ImportRobot, VisualsKeepTheColorOfTheDescriptionOrElseOfTheirMesh) {
  const std::string mesh = R"(<mesh filename="part.dae"/>)",
                    blue = R"(<material name="blue"><color rgba="0 0 1 1"/></material>)";
  const std::string own = R"(<visual><geometry>)" + mesh + R"(</geometry>)" + blue + "</visual>";
  Import import(robot(
      chassis("base_link", shape("visual", mesh)) + two_wheels() + caster() +
      joint("j", "fixed", "base_link", "x", "0 0 0") + link("x", own) + joint("k", "fixed", "base_link", "y", "0 0 0") +
      link("y", R"(<visual><geometry><box size="1 1 1"/></geometry><material name="blue"/></visual>)")));
  write_bytes(import.folder / "part.dae", dae("0.1", "Z_UP"));
  import.load();
  EXPECT_EQ(import.robot.meshes.size(), 1U);
  EXPECT_THAT(import.robot.urdf, HasSubstr(R"(<material name="color_0"><color rgba="1 0.5 0 1"/></material>)"));
  EXPECT_THAT(import.robot.urdf, HasSubstr(R"(<material name="color_1"><color rgba="0 0 1 1"/></material>)"));
  EXPECT_THAT(import.robot.urdf, HasSubstr(R"(<box size="1 1 1"/></geometry><material name="color_1"/>)"));
  EXPECT_THAT(import.robot.meshes[0].second, Not(HasSubstr("mtllib")));
}

TEST(ImportRobot, AChassisOfSeveralMeshPartsHasOneConvexPieceForEach) {
  Import import(
      robot(link("base_link", inertial(20.0, "0 0 0", 0.5) + shape("collision", R"(<mesh filename="body.stl"/>)")) +
            two_wheels() + caster()));
  std::vector<Triangle> parts = box_triangles({0.6, 0.4, 0.1});
  for (const Triangle& triangle : box_triangles({0.1, 0.1, 0.3}, {0.2, 0.0, 0.3})) parts.push_back(triangle);
  write_bytes(import.folder / "body.stl", stl(parts));
  import.load();
  ASSERT_EQ(import.robot.meshes.size(), 2U);
  EXPECT_THAT(import.robot.urdf, HasSubstr(R"(<mesh filename="meshes/body_hull_2.obj"/>)"));
}

}  // namespace
}  // namespace patrol::importer::mesh_import_test
