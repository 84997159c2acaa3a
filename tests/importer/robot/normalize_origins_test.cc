#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/importer/robot/description.h"
#include "tests/importer/robot/import.h"
#include "tests/support/pose_near.h"

namespace patrol::importer::normalize_origins_test {
namespace {

using test::VectorNear;
using ::testing::AllOf, ::testing::HasSubstr, ::testing::Not;

/// A mast of 3 cm radius and 0.5 m height on the chassis, with visual and collision.
std::string mast() {
  const std::string rod = cylinder(0.03, 0.5);
  return joint("mast_joint", "fixed", "base_link", "mast", "0.2 0 0.1") +
         link("mast", inertial(1.0) + shape("visual", rod, "0 0 0.25") + shape("collision", rod, "0 0 0.25"));
}

/// A lidar on the mast.
std::string head(const std::string& xyz, const std::string& content = "", const std::string& rpy = "0 0 0") {
  return joint("head_joint", "fixed", "mast", "head", xyz, "", rpy) + link("head", content) +
         R"(<gazebo reference="head"><sensor type="ray" name="x"/></gazebo>)";
}

TEST(SensorOrigin, ALidarOnTopOfAMastIsLiftedClearOfIt) {
  Import import(with(mast() + head("0 0 0.5")));
  EXPECT_THAT(import.load().T_body("lidar").position, VectorNear(Eigen::Vector3d(0.2, 0.0, 0.62), 1e-6));
  EXPECT_THAT(import.assumptions(),
              HasSubstr("| lidar | its origin is moved up by 0.020 m: in the file it is only 0.000 m from a visual of "
                        "mast, and its mount has a tolerance of 0.003 m, where its beams would end | mounts in "
                        "imported.yaml |"));
}

TEST(SensorOrigin, ALidarInsideAMastIsLiftedAndOneClearOfItStays) {
  Import inside(with(mast() + head("0 0 0.45")));
  EXPECT_THAT(inside.load().T_body("lidar").position, VectorNear(Eigen::Vector3d(0.2, 0.0, 0.62), 1e-6));
  EXPECT_THAT(inside.assumptions(), HasSubstr("0.030 m inside a visual of mast"));
  Import clear(with(mast() + head("0 0 0.51")));
  EXPECT_THAT(clear.load().T_body("lidar").position, VectorNear(Eigen::Vector3d(0.2, 0.0, 0.61), 1e-9));
  EXPECT_THAT(clear.assumptions(), Not(HasSubstr("its origin")));
}

TEST(SensorOrigin, ALidarInAFrontFaceMovesForwardAndOneDeepInTheChassisToTheNearestSide) {
  const std::string hull = shape("visual", box(0.6, 0.4, 0.8));
  const auto on_hull = [&hull](const std::string& xyz) {
    return robot(chassis("base_link", hull) + two_wheels() + caster() +
                 joint("head_joint", "fixed", "base_link", "head", xyz) + link("head") +
                 R"(<gazebo reference="head"><sensor type="ray" name="x"/></gazebo>)");
  };
  Import face(on_hull("0.3 0 0.1"));
  EXPECT_THAT(face.load().T_body("lidar").position, VectorNear(Eigen::Vector3d(0.32, 0.0, 0.1), 1e-6));
  EXPECT_THAT(face.assumptions(), HasSubstr("its origin is moved forward by 0.020 m"));
  Import deep(on_hull("-0.02 0.02 -0.02"));
  deep.load();
  EXPECT_THAT(deep.assumptions(), HasSubstr("its origin is moved to the left by 0.200 m"));
}

TEST(SensorOrigin, AHousingStaysWhenTheOriginMoves) {
  Import import(with(mast() + head("0 0 0.5", shape("visual", cylinder(0.04, 0.06), "0 0 0.03"))));
  EXPECT_THAT(import.load().T_body("lidar").position, VectorNear(Eigen::Vector3d(0.2, 0.0, 0.62), 1e-6));
  const std::string& urdf = import.robot.urdf;
  const std::size_t begin = urdf.find("<link name=\"lidar\"");
  EXPECT_THAT(urdf.substr(begin, 300), HasSubstr("xyz=\"0 0 0.01\""));
}

TEST(SensorOrigin, ATiltedScanPlaneIsARowAndALidarUpsideDownIsNone) {
  Import upright(with(mast() + head("0 0 0.6", "", "0 1.5708 0")));
  upright.load();
  EXPECT_THAT(upright.assumptions(), HasSubstr("| lidar | its scan plane is tilted by 90 degrees: mapping and "
                                               "navigation need a horizontal one |"));
  Import flipped(with(mast() + head("0 0 0.6", "", "3.14159 0.1 0")));
  flipped.load();
  EXPECT_THAT(flipped.assumptions(), Not(HasSubstr("scan plane")));
}

}  // namespace
}  // namespace patrol::importer::normalize_origins_test
