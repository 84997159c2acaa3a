#include "slam/grid_map.h"

#include <algorithm>
#include <set>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "core/random.h"
#include "tests/support/pose_near.h"

namespace patrol::slam::grid_map_test {
namespace {

using test::VectorNear;

constexpr double kResolution_m = 0.1;

GridMap make_map() { return GridMap(kResolution_m, 100.0); }

GridCell cell_of(const GridMap& map, Cell cell) {
  const std::optional<GridCell> found = map.find(cell);
  return found ? *found : GridCell{};
}

/// A ray through the middle of row 0 from the middle of column `from` to the middle of column `to`.
void add_row_ray(GridMap& map, int from, int to, int weight = 1, bool stop_at_surface = false) {
  map.add_free_ray(map.center_of({from, 0}), map.center_of({to, 0}), weight, stop_at_surface);
}

TEST(GridCell, IsSurfaceWhileAtLeastAFifthOfTheBeamsEndedThere) {
  EXPECT_FALSE(GridCell{}.is_surface());
  EXPECT_TRUE((GridCell{.hits = 1, .passes = 4}).is_surface());
  EXPECT_FALSE((GridCell{.hits = 1, .passes = 5}).is_surface());
  EXPECT_TRUE((GridCell{.hits = 10, .passes = 40}).is_surface());
  EXPECT_FALSE((GridCell{.hits = 10, .passes = 41}).is_surface());
}

TEST(GridMap, ABeamOfTenCellsPassesTenCellsOnceAndNoOther) {
  GridMap map = make_map();
  add_row_ray(map, 0, 9);
  for (int col = -2; col < 13; ++col) {
    EXPECT_EQ(cell_of(map, {col, 0}).passes, col >= 0 && col <= 9 ? 1 : 0) << col;
    EXPECT_EQ(cell_of(map, {col, 1}).passes, 0);
  }
}

TEST(GridMap, ABeamPassesTheCellsThatItsPointsLieIn) {
  const RandomStream stream(1, "test/rays");
  for (std::uint64_t i = 0; i < 30; ++i) {
    GridMap map = make_map();
    const Eigen::Vector2d from(8.0 * stream.uniform(i, 0) - 4.0, 8.0 * stream.uniform(i, 1) - 4.0);
    const Eigen::Vector2d to(8.0 * stream.uniform(i, 2) - 4.0, 8.0 * stream.uniform(i, 3) - 4.0);
    map.add_free_ray(from, to, 1, false);
    std::set<std::pair<int, int>> crossed;  // by points every fiftieth of a millimeter or so
    constexpr int kPoints = 200'000;
    for (int k = 0; k <= kPoints; ++k) {
      const Cell cell = map.cell_at(from + (to - from) * k / kPoints);
      crossed.insert({cell.col, cell.row});
    }
    std::size_t passed = 0;
    map.for_each_tile([&](Cell, const GridTile& tile) {
      for (const std::uint16_t passes : tile.passes) passed += passes;
    });
    EXPECT_LE(passed - crossed.size(), 1U) << "a corner nicked between two points";
    for (const auto& [col, row] : crossed) EXPECT_EQ(cell_of(map, {col, row}).passes, 1);
  }
}

TEST(GridMap, HitsKeepTheirMeanWithinTheCell) {
  GridMap map = make_map();
  map.add_hit({0.31, -0.02});
  map.add_hit({0.33, -0.04});
  map.add_hit({0.38, -0.09});
  const GridCell cell = cell_of(map, {3, -1});
  EXPECT_EQ(cell.hits, 3);
  // Mean (0.34, -0.05) from the center (0.35, -0.05).
  EXPECT_NEAR(cell.mean_x_m, -0.01, 1e-7);
  EXPECT_NEAR(cell.mean_y_m, 0.0, 1e-7);
}

TEST(GridMap, FivePassesThroughTheMeanTakeASingleHitBack) {
  GridMap map = make_map();
  map.add_hit(map.center_of({5, 0}));
  add_row_ray(map, 0, 9, 4);
  EXPECT_TRUE(map.is_surface({5, 0}));
  add_row_ray(map, 0, 9);
  EXPECT_FALSE(map.is_surface({5, 0}));
}

TEST(GridMap, ABeamThatPassesAFifthOfACellFromTheMeanDoesNotClearIt) {
  GridMap map = make_map();
  map.add_hit(map.center_of({5, 0}) + Eigen::Vector2d(0.0, 0.021));
  add_row_ray(map, 0, 9, 100);
  EXPECT_EQ(cell_of(map, {5, 0}).passes, 0);
  map = make_map();
  map.add_hit(map.center_of({5, 0}) + Eigen::Vector2d(0.0, 0.019));
  add_row_ray(map, 0, 9, 100);
  EXPECT_EQ(cell_of(map, {5, 0}).passes, 100);
}

TEST(GridMap, ABeamWithoutReturnClearsUpToTheFirstSurface) {
  GridMap map = make_map();
  map.add_hit(map.center_of({5, 0}));
  add_row_ray(map, 0, 9, 1, true);
  EXPECT_EQ(cell_of(map, {4, 0}).passes, 1);
  EXPECT_EQ(cell_of(map, {5, 0}).passes, 0);
  EXPECT_EQ(cell_of(map, {6, 0}).passes, 0);
}

TEST(GridMap, CountsStopAt65535) {
  GridMap map = make_map();
  for (int i = 0; i < 3; ++i) add_row_ray(map, 0, 0, 1), add_row_ray(map, 0, 1, 30'000);
  EXPECT_EQ(cell_of(map, {0, 0}).passes, 65535);
}

TEST(GridMap, ABeamOfZeroLengthHasNoEffect) {
  GridMap map = make_map();
  add_row_ray(map, 2, 2);
  EXPECT_EQ(map.num_tiles(), 0U);
}

TEST(GridMap, NothingIsKeptBeyondHalfItsExtent) {
  GridMap map(kResolution_m, 6.4);  // one tile of 3.2 m each way
  map.add_hit({3.15, -3.15});
  map.add_hit({3.25, 0.0});
  map.add_hit({0.0, -1e9});
  EXPECT_TRUE(map.is_surface({31, -32}));
  EXPECT_EQ(map.find({32, 0}), std::nullopt);
  EXPECT_EQ(map.num_tiles(), 1U);
}

TEST(GridMap, ACopySharesEveryTileUntilOneIsWritten) {
  GridMap map = make_map();
  for (double x : {0.05, 4.0, 8.0}) map.add_hit({x, 0.05});
  ASSERT_EQ(map.num_tiles(), 3U);
  ASSERT_EQ(map.num_unshared_tiles(), 3U);
  GridMap copy = map;
  EXPECT_EQ(map.num_unshared_tiles(), 0U);
  copy.add_hit({4.5, 0.05});
  EXPECT_EQ(map.num_unshared_tiles(), 1U);
  EXPECT_EQ(copy.num_unshared_tiles(), 1U);
  EXPECT_FALSE(map.is_surface(map.cell_at({4.5, 0.05})));
  EXPECT_TRUE(copy.is_surface(map.cell_at({4.5, 0.05})));
  EXPECT_EQ(map.find({0, 0}), copy.find({0, 0}));
}

/// Hits strewn over several tiles on both sides of the origin.
GridMap make_strewn_map(int hits) {
  GridMap map = make_map();
  const RandomStream stream(2, "test/strewn");
  for (std::uint64_t i = 0; i < static_cast<std::uint64_t>(hits); ++i) {
    map.add_hit({10.0 * stream.uniform(i, 0) - 5.0, 10.0 * stream.uniform(i, 1) - 5.0});
  }
  return map;
}

TEST(GridMap, FindsSurfaceNearbyAsASearchCellByCellDoes) {
  const GridMap map = make_strewn_map(150);
  for (const int radius : {0, 1, 3, 15}) {
    for (int row = -70; row <= 70; row += 3) {
      for (int col = -70; col <= 70; col += 3) {
        std::vector<Eigen::Vector2d> expected, found;
        for (int r = row - radius; r <= row + radius; ++r) {
          for (int c = col - radius; c <= col + radius; ++c) {
            const GridCell cell = cell_of(map, {c, r});
            if (cell.is_surface())
              expected.push_back(map.center_of({c, r}) + Eigen::Vector2d(cell.mean_x_m, cell.mean_y_m));
          }
        }
        map.for_each_surface_near(
            {col, row}, radius, [&](double mean_x_m, double mean_y_m, int) { found.emplace_back(mean_x_m, mean_y_m); });
        const auto by_place = [](const auto& a, const auto& b) {
          return a.y() < b.y() || (a.y() == b.y() && a.x() < b.x());
        };
        std::sort(expected.begin(), expected.end(), by_place);
        std::sort(found.begin(), found.end(), by_place);
        ASSERT_EQ(found, expected) << col << ' ' << row << " radius " << radius;
        ASSERT_EQ(map.is_surface_within({col, row}, radius), !expected.empty());
      }
    }
  }
}

}  // namespace
}  // namespace patrol::slam::grid_map_test
