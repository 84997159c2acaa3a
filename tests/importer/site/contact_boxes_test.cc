#include "importer/site/points/contact_boxes.h"

#include <gtest/gtest.h>

namespace patrol::importer {
namespace {

ScannedGround level_ground() {
  const GridGeometry grid{.resolution_m = 0.1, .width = 40, .height = 40, .origin_m = {-2.0, -2.0}};
  return {.height_m = Grid<float>(grid, 0.0f), .origin = Grid<GroundOrigin>(grid, GroundOrigin::kMeasured)};
}

/// Upright rectangle that faces y, from a corner.
Patch upright(const Eigen::Vector3f& low, float width_m, float height_m) {
  Patch patch{.corners_m = {}, .num_corners = 4};
  patch.corners_m[0] = low;
  patch.corners_m[1] = low + Eigen::Vector3f(width_m, 0.0f, 0.0f);
  patch.corners_m[2] = low + Eigen::Vector3f(width_m, 0.0f, height_m);
  patch.corners_m[3] = low + Eigen::Vector3f(0.0f, 0.0f, height_m);
  return patch;
}

TEST(ContactBoxes, SpecksOf25SquareCentimetersHaveNone) {
  EXPECT_TRUE(contact_boxes({upright({0.02f, 0.03f, 0.52f}, 0.05f, 0.05f)}, level_ground(), {}).empty());
}

TEST(ContactBoxes, PostOfTwoCentimetersHasBoxesOfItsHeight) {
  const std::vector<Eigen::AlignedBox3d> boxes =
      contact_boxes({upright({0.02f, 0.03f, 0.0f}, 0.02f, 1.4f)}, level_ground(), {});
  ASSERT_FALSE(boxes.empty());
  Eigen::AlignedBox3d all;
  for (const Eigen::AlignedBox3d& box : boxes) all.extend(box);
  EXPECT_NEAR(all.min().z(), 0.1, 0.05);
  EXPECT_NEAR(all.max().z(), 1.4, 0.05);
  EXPECT_LT(all.sizes().head<2>().maxCoeff(), 0.03);
}

}  // namespace
}  // namespace patrol::importer
