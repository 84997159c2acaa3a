#include "slam/submaps/observed_cells.h"

#include <gtest/gtest.h>

namespace patrol::slam::observed_cells_test {
namespace {

using State = ObservedCells::State;

// A beam along y = 0.02 from x = 0 to 1, a hit at the end, on cells of 5 cm; seen on cells of 25 cm.
TEST(ObservedCells, ABeamAlongARowIsFreeToItsHit) {
  GridMap map(0.05, 100.0);
  map.add_free_ray({0.02, 0.02}, {0.97, 0.02}, 1, false);
  map.add_hit({1.02, 0.02});
  const ObservedCells observed(map, 0.25);
  EXPECT_EQ(observed.num_observed(), 5);
  EXPECT_EQ(observed.at({0.1, 0.1}), State::kFree);
  EXPECT_EQ(observed.at({0.9, 0.2}), State::kFree);
  EXPECT_EQ(observed.at({1.1, 0.1}), State::kSurface);
  EXPECT_EQ(observed.at({1.3, 0.1}), State::kUnknown);
  EXPECT_EQ(observed.at({0.1, -0.1}), State::kUnknown);
  EXPECT_EQ(observed.at({-500.0, 500.0}), State::kUnknown);
}

TEST(ObservedCells, ASurfaceIsNearInTheEightCellsAround) {
  GridMap map(0.05, 100.0);
  map.add_hit({1.02, 0.02});
  const ObservedCells observed(map, 0.25);
  EXPECT_TRUE(observed.is_surface_near({0.8, -0.2}));
  EXPECT_TRUE(observed.is_surface_near({1.4, 0.4}));
  EXPECT_FALSE(observed.is_surface_near({0.7, 0.1}));
}

TEST(ObservedCells, VisitsWhatIsKnownAndNothingOfAnEmptyMap) {
  GridMap map(0.05, 100.0);
  map.add_hit({-3.0, 2.0});
  map.add_hit({4.0, -1.0});
  int visits = 0;
  const ObservedCells observed(map, 0.25);
  observed.for_each_observed([&](const Eigen::Vector2d& center) {
    EXPECT_EQ(observed.at(center), State::kSurface);
    ++visits;
  });
  EXPECT_EQ(visits, 2);
  const ObservedCells nothing(GridMap(0.05, 100.0), 0.25);
  EXPECT_EQ(nothing.num_observed(), 0);
  EXPECT_EQ(nothing.at({0.0, 0.0}), State::kUnknown);
}

}  // namespace
}  // namespace patrol::slam::observed_cells_test
