#include "slam/submaps/seen_cells.h"

#include <gtest/gtest.h>

namespace patrol::slam::seen_cells_test {
namespace {

using State = SeenCells::State;

// A beam along y = 0.02 from x = 0 to 1, a hit at the end, on cells of 5 cm; seen on cells of 25 cm.
TEST(SeenCells, ABeamAlongARowIsFreeToItsHit) {
  GridMap map(0.05, 100.0);
  map.add_free_ray({0.02, 0.02}, {0.97, 0.02}, 1, false);
  map.add_hit({1.02, 0.02});
  const SeenCells seen(map, 0.25);
  EXPECT_EQ(seen.num_known(), 5);
  EXPECT_EQ(seen.at({0.1, 0.1}), State::kFree);
  EXPECT_EQ(seen.at({0.9, 0.2}), State::kFree);
  EXPECT_EQ(seen.at({1.1, 0.1}), State::kSurface);
  EXPECT_EQ(seen.at({1.3, 0.1}), State::kUnknown);
  EXPECT_EQ(seen.at({0.1, -0.1}), State::kUnknown);
  EXPECT_EQ(seen.at({-500.0, 500.0}), State::kUnknown);
}

TEST(SeenCells, ASurfaceIsNearInTheEightCellsAround) {
  GridMap map(0.05, 100.0);
  map.add_hit({1.02, 0.02});
  const SeenCells seen(map, 0.25);
  EXPECT_TRUE(seen.is_surface_near({0.8, -0.2}));
  EXPECT_TRUE(seen.is_surface_near({1.4, 0.4}));
  EXPECT_FALSE(seen.is_surface_near({0.7, 0.1}));
}

TEST(SeenCells, VisitsWhatIsKnownAndNothingOfAnEmptyMap) {
  GridMap map(0.05, 100.0);
  map.add_hit({-3.0, 2.0});
  map.add_hit({4.0, -1.0});
  int visits = 0;
  const SeenCells seen(map, 0.25);
  seen.for_each_known([&](const Eigen::Vector2d& center) {
    EXPECT_EQ(seen.at(center), State::kSurface);
    ++visits;
  });
  EXPECT_EQ(visits, 2);
  const SeenCells nothing(GridMap(0.05, 100.0), 0.25);
  EXPECT_EQ(nothing.num_known(), 0);
  EXPECT_EQ(nothing.at({0.0, 0.0}), State::kUnknown);
}

}  // namespace
}  // namespace patrol::slam::seen_cells_test
