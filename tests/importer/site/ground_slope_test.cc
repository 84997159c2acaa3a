#include "importer/site/ground_slope.h"

#include <cmath>
#include <functional>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/geometry/angles.h"
#include "tests/importer/site/mesh_files.h"

namespace patrol::importer::ground_slope_test {
namespace {

using ::testing::AllOf, ::testing::HasSubstr;

Grid<float> ground_of(const std::function<double(const Eigen::Vector2d&)>& height_m) {
  const GridGeometry grid{.resolution_m = 0.1, .width = 100, .height = 80};
  Grid<float> heights(grid);
  for (int row = 0; row < grid.height; ++row) {
    for (int col = 0; col < grid.width; ++col)
      heights.at({col, row}) = static_cast<float>(height_m(grid.center_of({col, row})));
  }
  return heights;
}

TEST(GroundSlope, OfAnInclinedPlaneIsItsInclinationInAnyDirection) {
  const GroundSlopes slopes =
      slopes_of(ground_of([](const Eigen::Vector2d& p) { return 0.03 * p.x() - 0.04 * p.y(); }), {});
  EXPECT_NEAR(slopes.max_rad, std::atan(0.05), 1e-4);
  EXPECT_EQ(slopes.steep_ratio, 1.0);
  EXPECT_EQ(slopes_of(ground_of([](const Eigen::Vector2d& p) { return 0.03 * p.x(); }), {}).steep_ratio, 0.0);
}

TEST(GroundSlope, CellsThatAreFilledInDoNotCount) {
  const Grid<float> ground = ground_of([](const Eigen::Vector2d& p) { return p.x() > 5.0 ? -2.0 : 0.0; });
  EXPECT_GT(slopes_of(ground, {}).max_rad, 1.0);
  std::vector<char> is_ground(ground.values().size(), 1);
  for (std::size_t i = 0; i < is_ground.size(); ++i) is_ground[i] = i % 100 < 50 ? 1 : 0;
  EXPECT_EQ(slopes_of(ground, is_ground).max_rad, 0.0);
}

/// Mesh of a yard of 12 x 10 m with waves of a length of 6 m.
std::string yard(double amplitude_m) {
  Mesh mesh;
  const auto at = [&](int col, int row) {
    const double x = 0.2 * col, y = 0.2 * row;
    return Eigen::Vector3d(x, amplitude_m * std::sin(2.0 * M_PI * x / 6.0), -y);  // y is up
  };
  for (int row = 0; row < 50; ++row) {
    for (int col = 0; col < 60; ++col)
      add_quad(mesh, at(col, row + 1), at(col + 1, row + 1), at(col + 1, row), at(col, row));
  }
  return GltfText().of(mesh);
}

std::string slope_row(const std::string& text) {
  SiteFileImport import("yard.gltf", text);
  for (const Assumption& row : import.read().assumptions) {
    if (row.subject == "slopes") return row.text + "; " + row.override_with;
  }
  return "";
}

// Slopes of up to 0.1 * 2 pi / 6 = 6.0 degrees, over 1 m 5.7 degrees.
TEST(GroundSlope, AnImportedYardWithReliefHasARowThatTheSlamAssumesLevelGround) {
  EXPECT_THAT(slope_row(yard(0.1)), AllOf(HasSubstr("slopes of up to 5.7 degrees"),
                                          HasSubstr("the built-in SLAM assumes level ground"), HasSubstr("--stack")));
  EXPECT_EQ(slope_row(yard(0.03)), "");
  EXPECT_EQ(slope_row(yard(0.0)), "");
}

}  // namespace
}  // namespace patrol::importer::ground_slope_test
