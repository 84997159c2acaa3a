#include "importer/robot/surface_distance.h"

#include <memory>
#include <string>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "core/frames.h"

namespace patrol::importer::surface_distance_test {
namespace {

double distance_m(const RobotSurface& surface, double x, double y, double z) {
  const auto clearance = surface.clearance({x, y, z}, 10.0);
  return clearance ? clearance->distance_m : 10.0;
}

TEST(RobotSurface, DistancesFromPrimitivesAreSignedAndOfTheNearestOne) {
  RobotSurface surface;
  surface.add("box", {.type = ShapeType::kBox, .size_m = {2.0, 4.0, 6.0}}, {});
  surface.add("mast", {.type = ShapeType::kCylinder, .radius_m = 0.1, .length_m = 2.0}, {.position = {5.0, 0.0, 0.0}});
  surface.add("ball", {.type = ShapeType::kSphere, .radius_m = 0.5}, {.position = {-5.0, 0.0, 0.0}});
  EXPECT_DOUBLE_EQ(distance_m(surface, 0.75, 0.0, 0.0), -0.25);
  EXPECT_NEAR(distance_m(surface, 0.0, 5.0, 7.0), 5.0, 1e-12);
  EXPECT_NEAR(distance_m(surface, 5.0, 0.05, 0.5), -0.05, 1e-12);
  EXPECT_NEAR(distance_m(surface, 5.0, 0.0, 1.3), 0.3, 1e-12);
  EXPECT_NEAR(distance_m(surface, -5.0, 0.0, 0.9), 0.4, 1e-12);
  EXPECT_EQ(surface.clearance({5.0, 0.0, 1.3}, 10.0)->link, "mast");
  EXPECT_FALSE(surface.clearance({5.0, 0.0, 1.3}, 0.3).has_value());
}

/// Unit cube about the origin; without its top, half of the triangles of the cube's last side are missing.
Shape cube(bool is_complete) {
  MeshPart part;
  for (int i = 0; i < 8; ++i) part.mesh.vertices_m.emplace_back((i & 1) - 0.5, ((i >> 1) & 1) - 0.5, (i >> 2) - 0.5);
  part.mesh.triangles = {{0, 2, 1}, {1, 2, 3}, {0, 1, 4}, {1, 5, 4}, {2, 6, 3}, {3, 6, 7},
                         {0, 4, 2}, {2, 4, 6}, {1, 3, 5}, {3, 7, 5}, {4, 5, 6}};
  if (is_complete) part.mesh.triangles.push_back({5, 7, 6});
  return {.type = ShapeType::kMesh, .mesh = std::make_shared<const std::vector<MeshPart>>(1, std::move(part))};
}

TEST(RobotSurface, AMeshHasAnInsideAlsoWithAGap) {
  for (const bool is_complete : {true, false}) {
    RobotSurface surface;
    surface.add("cube", cube(is_complete), {.position = {1.0, 0.0, 0.0}});
    EXPECT_NEAR(distance_m(surface, 1.0, 0.0, -0.4), -0.1, 1e-12) << is_complete;
    EXPECT_NEAR(distance_m(surface, 1.2, 0.3, -0.75), 0.25, 1e-12) << is_complete;
    EXPECT_NEAR(distance_m(surface, 1.0, 0.9, -0.8), 0.5, 1e-12) << is_complete;
  }
}

}  // namespace
}  // namespace patrol::importer::surface_distance_test
