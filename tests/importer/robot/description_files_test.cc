#include <cstdlib>
#include <filesystem>
#include <string>

#include <Eigen/Core>
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "importer/xacro.h"
#include "tests/importer/robot/description.h"
#include "tests/importer/robot/import.h"
#include "tests/support/pose_near.h"
#include "tests/support/temporary_file.h"

/// Shapes, mesh files and xacro of public descriptions.
namespace patrol::importer::description_files_test {
namespace {

using test::write_bytes;
using ::testing::AllOf, ::testing::HasSubstr, ::testing::MatchesRegex, ::testing::Not;

TEST(PublicDescription, SpheresWithoutSizeAreLeftOut) {
  Import import(with(part("toe", shape("visual", sphere(0.0)) + shape("collision", sphere(0.0)))));
  import.load();
  EXPECT_THAT(import.assumptions(), AllOf(HasSubstr("| toe | its visual sphere of radius 0 is left out"),
                                          HasSubstr("| toe | its collision sphere of radius 0 is left out")));
}

TEST(PublicDescription, AFourthNumberOfAScaleIsLeftOut) {
  Import import(with(part("x", shape("visual", R"(<mesh filename="m.stl" scale="0.001 0.001 0.002 1"/>)"))));
  write_bytes(import.folder / "m.stl", stl(box_triangles({100.0, 100.0, 100.0})));
  import.load();
  EXPECT_THAT(import.assumptions(), HasSubstr("| x | the fourth number of the scale of its mesh is left out |"));
  EXPECT_THAT(import.robot.meshes[0].second, HasSubstr(" 0.1\n")) << "scaled by 0.002 along z";
  Import five(with(part("x", shape("visual", R"(<mesh filename="m.stl" scale="1 1 1 1 1"/>)"))));
  EXPECT_THAT(complaint(five), HasSubstr("x: scale = \"1 1 1 1 1\": must be 3 numbers"));
}

TEST(PublicDescription, MisspelledElementsAreReported) {
  Import import(with(part("x", shape("visual", sphere(0.1)) + shape("colision", sphere(0.1)) + "<contact/>")));
  import.load();
  EXPECT_THAT(import.assumptions(),
              HasSubstr("is left out: unknown element of &lt;link> | &lt;collision>, if it is meant"));
  EXPECT_THAT(import.assumptions(), Not(HasSubstr("&lt;contact>")));
  Import correct(with(part("x", shape("visual", sphere(0.1)) + shape("collision", sphere(0.1)))));
  correct.load();
  EXPECT_THAT(correct.assumptions(), Not(HasSubstr("unknown element")));
}

/// A description in urdf/ with a collision mesh, and the mesh in a folder beside it.
void expect_found(const std::string& filename, const std::string& where, bool is_found) {
  Import import(with(part("x", shape("collision", fmt::format(R"(<mesh filename="{}"/>)", filename)))));
  for (const char* folder : {"urdf", "urdf/assets", "urdf/other", "meshes"})
    std::filesystem::create_directories(import.folder / "pkg" / folder);
  const std::filesystem::path file = import.folder / "pkg/urdf/vendor.urdf";
  std::filesystem::rename(import.options.file, file);
  import.options.file = file;
  write_bytes(import.folder / "pkg" / where, stl(box_triangles({0.1, 0.1, 0.1})));
  const std::string message = complaint(import);
  if (is_found) {
    EXPECT_EQ(message, "") << filename;
    EXPECT_THAT(import.assumptions(), HasSubstr("| part.stl | not found where the description names them")) << filename;
  } else {
    EXPECT_THAT(message, MatchesRegex("vendor.urdf:[0-9]+: x: .*")) << filename;
  }
}

TEST(PublicDescription, MeshesNearTheDescriptionAreFound) {
  expect_found("meshes/part.stl", "meshes/part.stl", true);                          // one folder above
  expect_found("/home/vendor/ws/src/pkg/meshes/part.stl", "meshes/part.stl", true);  // another computer
  expect_found("file:///home/vendor/meshes/part.stl", "meshes/part.stl", true);
  expect_found("package://vendor_description/meshes/part.stl", "meshes/part.stl", true);
  expect_found("meshes/trunk/part.stl", "urdf/assets/part.stl", true);  // the only file of its name
  expect_found("meshes/part.stl", "urdf/assets/part_2.stl", false);
  expect_found("package://vendor_description/meshes/part.stl", "meshes/part_2.stl", false);
}

TEST(PublicDescription, OfSeveralMeshesOfOneNameNoneIsChosen) {
  Import import(with(part("x", shape("collision", R"(<mesh filename="meshes/part.stl"/>)"))));
  for (const char* folder : {"a", "b"}) {
    std::filesystem::create_directories(import.folder / folder);
    write_bytes(import.folder / folder / "part.stl", stl(box_triangles({0.1, 0.1, 0.1})));
  }
  EXPECT_THAT(complaint(import), MatchesRegex("vendor.urdf:[0-9]+: x: .*/meshes/part.stl: mesh file not found: put it "
                                              "there, or give the folder of its package with --package NAME=FOLDER"));
}

TEST(PublicDescription, ALinkWhoseMeshIsMissingIsDrawnAsItsCollisionShapeAndOneWithoutItIsNotDrawn) {
  const std::string missing = shape("visual", R"(<mesh filename="nowhere/logo.dae"/>)");
  Import import(with(part("x", missing + shape("collision", box(0.1, 0.11, 0.12))) +
                     part("y", missing + shape("visual", sphere(0.07)) + shape("collision", box(0.1, 0.1, 0.13))) +
                     part("logo", missing)));
  import.load();
  EXPECT_THAT(
      import.assumptions(),
      AllOf(HasSubstr("| x | is drawn as its collision shape instead of nowhere/logo.dae: mesh file not found |"),
            HasSubstr("| y, logo | is drawn without nowhere/logo.dae: mesh file not found |")));
  const auto num_of = [&import](const std::string& size) {
    std::size_t count = 0;
    for (std::size_t at = 0; (at = import.robot.urdf.find(size, at)) != std::string::npos; ++at) ++count;
    return count;
  };
  EXPECT_EQ(num_of("size=\"0.1 0.11 0.12\""), 2U) << "visual and collision";
  EXPECT_EQ(num_of("size=\"0.1 0.1 0.13\""), 1U) << "another visual is drawn";
  // Without a collision shape, the visual of a moving part is its contact shape.
  Import wheel(robot(chassis() + two_wheels() + caster() +
                     joint("j", "continuous", "base_link", "w", "0.2 0 0.3", axis("0 1 0")) + link("w", missing)));
  EXPECT_THAT(complaint(wheel), MatchesRegex("vendor.urdf:[0-9]+: w: .*mesh file not found.*"));
}

TEST(PublicDescription, ExpressionsOfXacroAreFoundInAUrdfFile) {
  EXPECT_TRUE(has_xacro_text(with(part("imu", "<visual><origin xyz=\"$(optenv IMU_XYZ 0 0 0)\"/></visual>"))));
  EXPECT_TRUE(has_xacro_text(with("<link name=\"${name}\"/>")));
  EXPECT_TRUE(has_xacro_text("<robot><xacro:macro name=\"a\"/></robot>"));
  EXPECT_FALSE(has_xacro_text(with("")));
  EXPECT_FALSE(has_xacro_text(with("<gazebo><plugin name=\"$(arg a)\"/></gazebo>"))) << "not part of the robot";
  EXPECT_FALSE(has_xacro_text("<robot><!-- $(arg a) --></robot>"));
  EXPECT_FALSE(has_xacro_text("no XML"));
}

TEST(PublicDescription, AUrdfFileWithExpressionsOfXacroIsExpandedOrNamesWhatIsMissing) {
  Import import(with(part("imu", "") +
                     joint("j", "fixed", "base_link", "camera", "$(optenv PATROL_TEST_XYZ 0.1 0 0.2)") +
                     link("camera")));
  const bool has_xacro = std::system("${PATROL_PYTHON:-python3} -c 'import xacro' 2> /dev/null") == 0;
  const std::string message = complaint(import);
  if (has_xacro) {
    EXPECT_EQ(message, "");
    EXPECT_THAT(import.assumptions(), HasSubstr("| vendor.urdf | has expressions of xacro and is expanded by xacro | "
                                                "--xacro-arg NAME=VALUE and environment variables"));
    EXPECT_THAT(import.description.T_body_sensor.at("camera").position,
                test::VectorNear(Eigen::Vector3d(0.1, 0.0, 0.2), 1e-9));
  } else {
    EXPECT_THAT(message,
                HasSubstr("vendor.urdf: xacro is not available to expand its $(...), ${...} and <xacro:...>: "));
  }
}

TEST(PublicDescription, AModelOfAnotherFormatIsRefusedByItsName) {
  Import mujoco("<mujoco model=\"x\"/>"), sdf("<sdf version=\"1.9\"/>"), other("<html/>");
  EXPECT_EQ(complaint(mujoco), "vendor.urdf:1: is a model of MuJoCo: robots are read from URDF and xacro only");
  EXPECT_EQ(complaint(sdf), "vendor.urdf:1: is a model in SDF: robots are read from URDF and xacro only");
  EXPECT_EQ(complaint(other), "vendor.urdf:1: <robot> is missing: must be a URDF file");
}

}  // namespace
}  // namespace patrol::importer::description_files_test
