#include "importer/mesh.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/error.h"
#include "importer/hull.h"
#include "tests/importer/robot/description.h"
#include "tests/support/pose_near.h"
#include "tests/support/temporary_file.h"

namespace patrol::importer::mesh_test {
namespace {

using test::TemporaryFile, test::VectorNear;
using ::testing::HasSubstr;

Mesh mesh_of(const std::vector<Triangle>& triangles) {
  Mesh mesh;
  for (const Triangle& triangle : triangles) {
    const int first = static_cast<int>(mesh.vertices_m.size());
    mesh.vertices_m.insert(mesh.vertices_m.end(), triangle.begin(), triangle.end());
    mesh.triangles.push_back({first, first + 1, first + 2});
  }
  return mesh;
}

TEST(Mesh, VolumeCenterAndInertiaOfABoxAreThoseOfTheClosedForm) {
  const SolidProperties solid = integrate(mesh_of(box_triangles({0.2, 0.3, 0.4}, {1.0, 2.0, 3.0})));
  const double volume = 0.2 * 0.3 * 0.4;
  EXPECT_NEAR(solid.volume_m3, volume, 1e-12);
  EXPECT_THAT(solid.center_m, VectorNear(Eigen::Vector3d(1.0, 2.0, 3.0), 1e-12));
  EXPECT_NEAR(solid.inertia(0, 0), volume * (0.09 + 0.16) / 12.0, 1e-12);
  EXPECT_NEAR(solid.inertia(1, 1), volume * (0.04 + 0.16) / 12.0, 1e-12);
  EXPECT_NEAR(solid.inertia(2, 2), volume * (0.04 + 0.09) / 12.0, 1e-12);
  EXPECT_NEAR(solid.inertia(0, 1), 0.0, 1e-12);
}

TEST(Mesh, ABoxOfTrianglesWeldsToEightVerticesAndIsClosed) {
  Mesh mesh = welded(mesh_of(box_triangles({1, 1, 1})));
  EXPECT_EQ(mesh.vertices_m.size(), 8U);
  EXPECT_TRUE(is_closed(mesh));
  mesh.triangles.pop_back();
  EXPECT_FALSE(is_closed(mesh));
}

TEST(Mesh, MirroringKeepsTheVolumePositive) {
  const Mesh mesh = scaled(mesh_of(box_triangles({1, 2, 3})), {-1e-3, 1e-3, 1e-3});
  EXPECT_NEAR(integrate(mesh).volume_m3, 6e-9, 1e-15);
}

TEST(Mesh, AnStlIsReadBackFromItsObj) {
  const TemporaryFile file("box.stl", stl(box_triangles({0.2, 0.3, 0.4})));
  const std::vector<MeshPart> parts = load_mesh(file.path());
  ASSERT_EQ(parts.size(), 1U);
  EXPECT_FALSE(parts[0].has_color);
  EXPECT_NEAR(integrate(parts[0].mesh).volume_m3, 0.024, 1e-8);
  const TemporaryFile obj("box.obj", to_obj(parts[0].mesh));
  EXPECT_NEAR(integrate(load_mesh(obj.path())[0].mesh).volume_m3, 0.024, 1e-8);
}

TEST(Mesh, ADaeIsReadWithItsUnitItsNodesAndItsColorButNotTurnedByItsUpAxis) {
  for (const char* up_axis : {"Z_UP", "Y_UP"}) {
    const TemporaryFile file("part.dae", dae("0.01", up_axis));
    const std::vector<MeshPart> parts = load_mesh(file.path());
    ASSERT_EQ(parts.size(), 1U);
    EXPECT_TRUE(parts[0].has_color);
    EXPECT_NEAR(parts[0].rgba[1], 0.5, 1e-3);
    Eigen::Vector3d upper = Eigen::Vector3d::Constant(-1e9);
    for (const Eigen::Vector3d& v : parts[0].mesh.vertices_m) upper = upper.cwiseMax(v);
    EXPECT_THAT(upper, VectorNear(Eigen::Vector3d(0.02, 0.1, 0.04), 1e-6)) << up_axis;
  }
}

TEST(Mesh, AFileThatIsNoMeshIsRefusedWithItsName) {
  const TemporaryFile file("bad.stl", "no mesh");
  try {
    load_mesh(file.path());
    ADD_FAILURE();
  } catch (const InputError& error) {
    EXPECT_THAT(error.what(), HasSubstr("bad.stl: mesh "));
    EXPECT_EQ(std::string(error.what()).find('\n'), std::string::npos);
  }
}

TEST(Hull, OfACubeWithInnerPointsHasEightCornersAndItsVolume) {
  std::vector<Eigen::Vector3d> points;
  for (int x = 0; x < 5; ++x) {
    for (int y = 0; y < 5; ++y) {
      for (int z = 0; z < 5; ++z) points.emplace_back(0.25 * x, 0.25 * y, 0.25 * z);
    }
  }
  const Mesh hull = convex_hull(points, 64);
  EXPECT_TRUE(is_closed(hull));
  EXPECT_NEAR(integrate(hull).volume_m3, 1.0, 1e-9);
  EXPECT_LE(hull.vertices_m.size(), 10U);
}

TEST(Hull, OfASphereWith64VerticesIsClosedAndWithin10PercentOfItsVolume) {
  std::vector<Eigen::Vector3d> points;
  for (int i = 0; i < 5000; ++i) {
    const double z = 1.0 - (2.0 * i + 1.0) / 5000, r = std::sqrt(1.0 - z * z), a = 2.399963 * i;
    points.emplace_back(r * std::cos(a), r * std::sin(a), z);
  }
  const Mesh hull = convex_hull(points, 64);
  EXPECT_TRUE(is_closed(hull));
  EXPECT_LE(hull.vertices_m.size(), 64U);
  EXPECT_GT(integrate(hull).volume_m3, 0.9 * 4.0 / 3.0 * M_PI);
}

TEST(Hull, OfAFlatPlateIsOneMillimeterThick) {
  const Mesh hull = convex_hull({{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}}, 64);
  EXPECT_TRUE(is_closed(hull));
  EXPECT_NEAR(integrate(hull).volume_m3, 1e-3, 1e-9);
}

TEST(Hull, PiecesAreOnePerComponentWithoutSmallAndEnclosedOnesAndAtMostEight) {
  std::vector<Triangle> triangles;
  const auto add = [&triangles](const std::vector<Triangle>& more) {
    triangles.insert(triangles.end(), more.begin(), more.end());
  };
  add(box_triangles({0.5, 0.5, 0.5}));
  add(box_triangles({0.1, 0.1, 0.1}));  // inside
  add(box_triangles({0.2, 0.2, 0.2}, {1.0, 0.0, 0.0}));
  add(box_triangles({0.01, 0.01, 0.01}, {2.0, 0.0, 0.0}));  // small
  const ConvexPieces pieces = convex_pieces(mesh_of(triangles));
  ASSERT_EQ(pieces.pieces.size(), 2U);
  EXPECT_EQ(pieces.num_dropped, 2);
  EXPECT_NEAR(integrate(pieces.pieces[0]).volume_m3, 0.125, 1e-9);
  EXPECT_NEAR(integrate(pieces.pieces[1]).volume_m3, 0.008, 1e-9);
  for (int i = 0; i < 12; ++i) add(box_triangles({0.1, 0.1, 0.1}, {3.0 + i, 0.0, 0.0}));
  EXPECT_EQ(convex_pieces(mesh_of(triangles)).pieces.size(), 8U);
}

}  // namespace
}  // namespace patrol::importer::mesh_test
