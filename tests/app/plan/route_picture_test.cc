#include "app/plan/route_picture.h"

#include <gtest/gtest.h>

namespace patrol::app::route_picture_test {
namespace {

/// Twenty cells by ten of 1 m, 24 pixels each: obstacles in the left column, what the inflation makes lethal beside
/// them, one unknown row on top.
class RoutePictureTest : public ::testing::Test {
 protected:
  RoutePictureTest() {
    for (int row = 0; row < 10; ++row) {
      occupancy.at({0, row}) = kOccupied;
      costs.at({0, row}) = costs.at({1, row}) = plan::kLethalCost;
      costs.at({2, row}) = plan::kMaxPassableCost;
    }
    occupancy.at({10, 9}) = kUnknown;
  }
  render::Frame draw(std::vector<Eigen::Vector2d> line_m) const {
    return draw_route(
        {.occupancy = occupancy, .costs = costs, .line_m = std::move(line_m), .marks = {}, .title = "t", .note = "n"});
  }
  /// The pixel in the middle of a cell, y up.
  static Color at(const render::Frame& frame, int col, int row) { return frame.at(24 * col + 12, 24 * (9 - row) + 12); }

  OccupancyGrid occupancy{{.resolution_m = 1.0, .width = 20, .height = 10}, kFree};
  Grid<plan::Cost> costs{{.resolution_m = 1.0, .width = 20, .height = 10}};
};

TEST_F(RoutePictureTest, ObstaclesInflationCostsAndTheUnknownAreToldApart) {
  const render::Frame frame = draw({});
  EXPECT_EQ(frame.width(), 720);  // of which the map takes 480
  const Color obstacle = at(frame, 0, 4), inflated = at(frame, 1, 4), dear = at(frame, 2, 4), free = at(frame, 6, 4),
              unknown = at(frame, 10, 9);
  EXPECT_LT(obstacle.r, 60);
  EXPECT_GT(inflated.r, inflated.b + 60);
  EXPECT_EQ(free, (Color{255, 255, 255}));
  EXPECT_TRUE(dear != free && dear != inflated && unknown != free && unknown != inflated);
}

TEST_F(RoutePictureTest, TheRouteLiesWhereItIsWithYUp) {
  const render::Frame frame = draw({{5.5, 1.5}, {15.5, 1.5}});
  EXPECT_GT(at(frame, 10, 1).b, 180);
  EXPECT_LT(at(frame, 10, 1).r, 60);
  EXPECT_EQ(at(frame, 10, 8), (Color{255, 255, 255}));
}

TEST(RoutePicture, AMapOfOneCellAndOneOfMillionsAreDrawn) {
  for (const int size : {1, 3000}) {
    const OccupancyGrid occupancy({.resolution_m = 0.05, .width = size, .height = size}, kFree);
    const Grid<plan::Cost> costs(occupancy.geometry());
    const render::Frame frame = draw_route({.occupancy = occupancy,
                                            .costs = costs,
                                            .line_m = {},
                                            .marks = {{{0.02, 0.02}, "start", kStartColor}},
                                            .title = "t",
                                            .note = "n"});
    EXPECT_LE(frame.width(), 1600);
    EXPECT_LE(frame.height(), 1100);
  }
}

}  // namespace
}  // namespace patrol::app::route_picture_test
