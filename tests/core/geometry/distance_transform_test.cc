#include "core/geometry/distance_transform.h"

#include <algorithm>
#include <tuple>

#include <gtest/gtest.h>

#include "core/random.h"

namespace patrol::distance_transform_test {
namespace {

using SquaredDistances = DistanceTransform::SquaredDistances;

/// About one cell in `sparsity` is an obstacle.
std::vector<std::uint8_t> make_random(int width, int height, double sparsity, std::uint64_t seed) {
  const RandomStream stream(seed, "test/obstacles");
  std::vector<std::uint8_t> cells(static_cast<std::size_t>(width) * static_cast<std::size_t>(height));
  for (std::size_t i = 0; i < cells.size(); ++i) cells[i] = stream.uniform(i) * sparsity < 1.0 ? 1 : 0;
  return cells;
}

/// Squared distances without a cap, from every cell to every obstacle; `kNoObstacle` without any.
std::vector<double> brute_force(const std::vector<std::uint8_t>& cells, int width, int height) {
  std::vector<double> result;
  for (int row = 0; row < height; ++row) {
    for (int col = 0; col < width; ++col) {
      double nearest = kNoObstacle;
      for (int i = 0; i < width * height; ++i) {
        if (cells[static_cast<std::size_t>(i)] == 0) continue;
        const int dx = i % width - col, dy = i / width - row;
        nearest = std::min(nearest, static_cast<double>(dx * dx + dy * dy));
      }
      result.push_back(nearest);
    }
  }
  return result;
}

/// Squared distances with a cap, as DistanceTransform gives them.
SquaredDistances brute_force(const std::vector<std::uint8_t>& cells, int width, int height, int cap) {
  SquaredDistances result;
  for (const double squared : brute_force(cells, width, height)) {
    result.push_back(static_cast<std::int16_t>(std::min(squared, cap * cap + 1.0)));
  }
  return result;
}

TEST(DistanceTransform, EqualsBruteForceOnRandomGrids) {
  std::uint64_t seed = 0;
  for (const double sparsity : {1.5, 20.0, 300.0}) {
    for (const int cap : {1, 2, 5, 13, 100}) {
      for (const auto& [width, height] : {std::pair{37, 23}, std::pair{1, 40}, std::pair{40, 1}, std::pair{1, 1}}) {
        const std::vector<std::uint8_t> cells = make_random(width, height, sparsity, ++seed);
        SquaredDistances squared;
        DistanceTransform(cap).compute(cells, width, height, squared);
        ASSERT_EQ(squared, brute_force(cells, width, height, cap)) << width << 'x' << height << " cap " << cap;
      }
    }
  }
}

TEST(DistanceTransform, AroundOneObstacleIsTheSumOfSquares) {
  std::vector<std::uint8_t> cells(7 * 5, 0);
  cells[2 * 7 + 3] = 1;  // column 3, row 2
  SquaredDistances squared;
  DistanceTransform(10).compute(cells, 7, 5, squared);
  EXPECT_EQ(squared[2 * 7 + 3], 0);
  EXPECT_EQ(squared[2 * 7 + 6], 9);      // 3 cells along the row
  EXPECT_EQ(squared[0 * 7 + 0], 9 + 4);  // 3 along, 2 across
}

TEST(DistanceTransform, OfAWindowEqualsThatPartOfTheWhole) {
  constexpr int kWidth = 61, kHeight = 47;
  DistanceTransform transform(9);
  std::uint64_t seed = 900;
  for (const double sparsity : {20.0, 300.0}) {
    const std::vector<std::uint8_t> cells = make_random(kWidth, kHeight, sparsity, ++seed);
    SquaredDistances whole, part;
    transform.compute(cells, kWidth, kHeight, whole);
    for (const DistanceTransform::Window& window :
         {DistanceTransform::Window{0, 0, 1, 1}, {3, 5, 16, 20}, {20, 10, 41, 37}, {60, 46, 1, 1}, {7, 0, 33, 47}}) {
      transform.compute(cells, kWidth, kHeight, window, part);
      ASSERT_EQ(part.size(), static_cast<std::size_t>(window.width * window.height));
      for (std::size_t i = 0; i < part.size(); ++i) {
        const int col = window.col + static_cast<int>(i) % window.width,
                  row = window.row + static_cast<int>(i) / window.width;
        ASSERT_EQ(part[i], whole[static_cast<std::size_t>(row * kWidth + col)]) << col << ' ' << row;
      }
    }
  }
}

TEST(DistanceTransform, WithoutObstaclesIsBeyondTheCapEverywhere) {
  SquaredDistances squared;
  DistanceTransform transform(4);
  transform.compute(std::vector<std::uint8_t>(6 * 3, 0), 6, 3, squared);
  EXPECT_EQ(squared, SquaredDistances(18, 4 * 4 + 1));
  EXPECT_EQ(transform.beyond(), 17);
}

TEST(DistanceTransform, TheSameObjectServesGridsOfAnySize) {
  DistanceTransform transform(6);
  SquaredDistances squared;
  for (const auto& [width, height] : {std::pair{30, 20}, std::pair{5, 5}, std::pair{12, 31}}) {
    const std::vector<std::uint8_t> cells = make_random(width, height, 15.0, 77);
    transform.compute(cells, width, height, squared);
    ASSERT_EQ(squared, brute_force(cells, width, height, 6));
  }
}

TEST(SquaredDistances, EqualBruteForceOnRandomGrids) {
  std::uint64_t seed = 500;
  for (const double sparsity : {1.5, 20.0, 300.0, 1e9}) {
    for (const auto& [width, height] :
         {std::pair{37, 23}, std::pair{1, 40}, std::pair{40, 1}, std::pair{1, 1}, std::pair{90, 4}}) {
      const std::vector<std::uint8_t> cells = make_random(width, height, sparsity, ++seed);
      ASSERT_EQ(squared_distances(cells, width, height), brute_force(cells, width, height)) << width << 'x' << height;
    }
  }
  EXPECT_TRUE(squared_distances({}, 0, 0).empty());
}

}  // namespace
}  // namespace patrol::distance_transform_test
