#include "io/points/point_reading.h"

#include <limits>

#include <gtest/gtest.h>

#include "io/points/pcd.h"
#include "tests/io/cloud_samples.h"

namespace patrol::io::point_reading_test {
namespace {

using test::TemporaryFolder, test::write_bytes;

const std::string kHeader =
    "ply\nformat ascii 1.0\nelement vertex 3\nproperty double x\nproperty double y\nproperty double z\n";

TEST(PointReading, CoordinatesOfMillionsOfMetersKeepMillimeters) {
  const TemporaryFolder folder;
  write_bytes(folder / "c.ply", kHeader +
                                    "end_header\n5411890.123 447312.456 212.5\n5411891.123 447312.457 212.5\n"
                                    "5411890.123 447312.456 213.75\n");
  const RelativePoints relative = load_points(folder / "c.ply");
  EXPECT_EQ(relative.origin, Eigen::Vector3d(5'411'900.0, 447'300.0, 200.0));
  ASSERT_EQ(relative.points.size(), 3U);
  EXPECT_NEAR(relative.points[0].x, -9.877f, 1e-5f);
  EXPECT_NEAR(relative.points[1].x - relative.points[0].x, 1.0f, 1e-5f);
  EXPECT_NEAR(relative.points[1].y - relative.points[0].y, 0.001f, 1e-5f);
  EXPECT_NEAR(relative.points[2].z, 13.75f, 1e-5f);
}

TEST(PointReading, FloatsOf32BitsHaveAStepAtTheirOrigin) {
  const TemporaryFolder folder;
  const std::vector<ScannerPoint> far = {{4'194'304.0f, 0.0f, 0.0f, 0.0f}}, near = {{4'194.0f, 0.0f, 0.0f, 0.0f}};
  save_pcd(folder / "far.pcd", far);
  save_pcd(folder / "near.pcd", near);
  EXPECT_NEAR(load_points(folder / "far.pcd").step, 0.5, 1e-3);
  EXPECT_EQ(load_points(folder / "near.pcd").step, 0.0);
  write_bytes(folder / "c.ply", kHeader + "end_header\n5411890.123 1 2\n0 0 0\n0 0 1\n");
  EXPECT_EQ(load_points(folder / "c.ply").step, 0.0);
}

TEST(PointReading, NearCoordinatesKeepTheirOrigin) {
  const TemporaryFolder folder;
  write_bytes(folder / "c.ply", kHeader + "end_header\n9999 1 2\n0 0 0\n0 0 1\n");
  EXPECT_EQ(load_points(folder / "c.ply").origin, Eigen::Vector3d::Zero().eval());
  EXPECT_EQ(load_points(folder / "c.ply").points[0].x, 9999.0f);
  EXPECT_EQ(load_points(folder / "c.ply", Eigen::Vector3d(1.0, 0.0, 0.0)).points[0].x, 9998.0f);
}

TEST(PointReading, TheLimitOf10KilometersAppliesToMetersAndNotToUnitsOfTheFile) {
  const TemporaryFolder folder;
  write_bytes(folder / "c.ply", kHeader + "end_header\n20000 1 2\n0 0 0\n0 0 1\n");
  EXPECT_EQ(load_points(folder / "c.ply", {}, 0.001).origin, Eigen::Vector3d::Zero().eval());
  EXPECT_EQ(load_points(folder / "c.ply").origin, Eigen::Vector3d(20000.0, 0.0, 0.0));
  EXPECT_EQ(load_points(folder / "c.ply", {}, 2.0).origin, Eigen::Vector3d(20000.0, 0.0, 0.0));
}

TEST(PointReading, ABigEndianPlyHasTheSamePoints) {
  const TemporaryFolder folder;
  const std::string header =
      "ply\nformat binary_big_endian 1.0\nelement vertex 1\nproperty float x\nproperty double y\nproperty short z\n"
      "end_header\n";
  write_bytes(folder / "c.ply", header + std::string("\x3F\xC0\x00\x00\x40\x04\x00\x00\x00\x00\x00\x00\xFF\xFE", 14));
  const RelativePoints relative = load_points(folder / "c.ply");
  ASSERT_EQ(relative.points.size(), 1U);
  EXPECT_EQ(relative.points[0].x, 1.5f);
  EXPECT_EQ(relative.points[0].y, 2.5f);
  EXPECT_EQ(relative.points[0].z, -2.0f);
}

TEST(PointReading, PointsThatAreNotFiniteAreDropped) {
  const TemporaryFolder folder;
  const float nan = std::numeric_limits<float>::quiet_NaN();
  save_pcd(folder / "c.pcd", {{nan, 0, 0, 0}, {1, 2, 3, 4}, {0, nan, 0, 0}});
  const RelativePoints relative = load_points(folder / "c.pcd");
  EXPECT_EQ(relative.num_dropped, 2U);
  ASSERT_EQ(relative.points.size(), 1U);
  EXPECT_EQ(relative.points[0].z, 3.0f);
}

TEST(PointReading, FacesMakeAMesh) {
  const TemporaryFolder folder;
  write_bytes(folder / "mesh.ply",
              kHeader +
                  "element face 1\nproperty list uchar int vertex_indices\nend_header\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n");
  write_bytes(folder / "cloud.ply", kHeader + "element face 0\nend_header\n0 0 0\n1 0 0\n0 1 0\n");
  EXPECT_TRUE(has_faces(folder / "mesh.ply"));
  EXPECT_FALSE(has_faces(folder / "cloud.ply"));
}

TEST(PointReading, ScansAreRelativeToTheFirstPose) {
  const TemporaryFolder folder;
  save_station_scans(folder / "scans", {{.station = "a",
                                         .T_map_scanner = {{30'012.0, 5.0, 1.0}, Eigen::Quaterniond::Identity()},
                                         .points = {{30'013.0f, 5.0f, 1.0f, 7.0f}}}});
  const RelativeScans relative = load_relative_scans(folder / "scans");
  EXPECT_EQ(relative.origin, Eigen::Vector3d(30'000.0, 0.0, 0.0));
  EXPECT_EQ(relative.scans[0].T_map_scanner.position, Eigen::Vector3d(12.0, 5.0, 1.0));
  EXPECT_EQ(relative.scans[0].points[0].x, 13.0f);
}

TEST(PointReading, TheExtensionSaysTheFormat) {
  const TemporaryFolder folder;
  for (const char* name : {"a.xyz", "a.pts", "a.ASC", "a.csv", "a.txt"}) {
    write_bytes(folder / name, "1 2 3 4\n");
    EXPECT_EQ(load_points(folder / name).points.at(0).intensity, 4.0F) << name;
  }
  EXPECT_EQ(complaint("c.las", "1 2 3", [](const auto& file) { load_points(file); }), "c.las: is not a LAS file");
  EXPECT_EQ(complaint("c.e57", "1 2 3", [](const auto& file) { load_points(file); }),
            "c.e57: extension of a point cloud must be .ply, .pcd, .las, .xyz, .pts, .asc, .csv, .txt");
}

}  // namespace
}  // namespace patrol::io::point_reading_test
