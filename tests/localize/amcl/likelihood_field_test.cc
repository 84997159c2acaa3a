#include "localize/amcl/likelihood_field.h"

#include <cmath>
#include <limits>

#include <gtest/gtest.h>

#include "localize/amcl/distance_to_occupied.h"

namespace patrol::localize::amcl_likelihood_field_test {
namespace {

constexpr double kRes = 0.1;

/// 40 x 30 free cells of 10 cm from (-1, -1), with a wall of one cell's thickness along y through x = 1.05.
OccupancyGrid make_map() {
  OccupancyGrid map({.resolution_m = kRes, .width = 40, .height = 30, .origin_m = {-1.0, -1.0}}, kFree);
  for (int row = 0; row < 30; ++row) map.at({20, row}) = kOccupied;
  return map;
}

LikelihoodField make_field(const OccupancyGrid& map, const LikelihoodFieldSettings& settings = {}) {
  return {settings, map, LineField(map, 6)};
}

/// The distance between two stored levels, -log(0.05) / 255: half of it for rounding, half for the cap at four sigmas.
constexpr double kLevelTol = 0.012;

LevelScan scan_of(const std::vector<Eigen::Vector2f>& ends) {
  LevelScan scan;
  for (const Eigen::Vector2f& end : ends) scan.beams.push_back({end, true});
  return scan;
}

TEST(DistanceToOccupied, IsThatOfEveryPairOfCellsTakenOneByOne) {
  OccupancyGrid map({.resolution_m = kRes, .width = 12, .height = 9}, kFree);
  map.at({3, 2}) = map.at({4, 2}) = map.at({9, 7}) = kOccupied;
  const Grid<float> distance_m = distance_to_occupied(map, 0.5);
  for (int row = 0; row < 9; ++row) {
    for (int col = 0; col < 12; ++col) {
      double nearest = 0.5;
      for (const Cell wall : {Cell{3, 2}, Cell{4, 2}, Cell{9, 7}})
        nearest = std::min(nearest, kRes * std::hypot(col - wall.col, row - wall.row));
      EXPECT_NEAR((distance_m.at({col, row})), nearest, 1e-6) << col << ' ' << row;
    }
  }
}

TEST(DistanceToOccupied, OfTheInsideOfAThickWallIsZero) {
  const OccupancyGrid map({.resolution_m = kRes, .width = 5, .height = 5}, kOccupied);
  const Grid<float> distance_m = distance_to_occupied(map, 1.0);
  for (const float value : distance_m.values()) EXPECT_EQ(value, 0.0F);
}

// 0.95 exp(-d^2 / 2 sigma^2) + 0.05 with sigma 0.1 at 0, 0.1 and 0.2 m from the wall, and 0.05 far away.
TEST(LikelihoodField, IsAGaussianOfTheDistanceOverAFloor) {
  const LikelihoodField field = make_field(make_map());
  for (const int cells : {0, 1, 2}) {
    const double expected = std::log(0.95 * std::exp(-0.5 * cells * cells) + 0.05);
    EXPECT_NEAR(field.log_at({1.05 + kRes * cells, 0.55}), expected, kLevelTol);
    EXPECT_NEAR(field.log_at({1.05 - kRes * cells, 0.55}), expected, kLevelTol);
  }
  EXPECT_NEAR(field.log_at({-0.5, 0.55}), std::log(0.05), kLevelTol);
}

TEST(LikelihoodField, OutsideOfTheMapIsAsFarAsCanBe) {
  const LikelihoodField field = make_field(make_map());
  for (const Eigen::Vector2d& p :
       {Eigen::Vector2d(1.05, 50.0), Eigen::Vector2d(-1e6, 0.5), Eigen::Vector2d(1e6, -1e6)}) {
    EXPECT_NEAR(field.log_at(p), std::log(0.05), kLevelTol);
    const BeamEnds end{{static_cast<float>(p.x())}, {static_cast<float>(p.y())}};
    EXPECT_NEAR(field.mean_log(end, {}), std::log(0.05), kLevelTol);
  }
}

// 150 ends: more than two blocks and a remainder.
TEST(LikelihoodField, TheFastSumIsTheMeanOverTheEndsOneByOne) {
  const LikelihoodField field = make_field(make_map());
  BeamEnds ends;
  for (int i = 0; i < 150; ++i) {
    ends.x_m.push_back(0.013F * static_cast<float>(i)),
        ends.y_m.push_back(0.4F * std::sin(0.3F * static_cast<float>(i)));
  }
  const Pose2 pose{0.2137, 0.3119, 0.37};
  double sum = 0.0;
  for (std::size_t i = 0; i < ends.size(); ++i) sum += field.log_at(pose * Eigen::Vector2d(ends.x_m[i], ends.y_m[i]));
  EXPECT_NEAR(field.mean_log(ends, pose), sum / 150.0,
              1e-3);  // a coordinate in single precision may fall into the next cell
}

// A third of the beams on a truck that the map does not know, half a meter or two meters in front of the wall: the pose
// that fits the wall loses the same.
TEST(LikelihoodField, AnUnmappedTruckCostsTheSameEverywhere) {
  const LikelihoodField field = make_field(make_map());
  const auto with_truck_at = [&](float x) { return field.mean_log({{1.05F, 1.05F, x}, {0.1F, 0.3F, 0.5F}}, {}); };
  EXPECT_NEAR(with_truck_at(0.5F), std::log(0.05) / 3.0, kLevelTol);
  EXPECT_NEAR(with_truck_at(-0.9F), with_truck_at(0.5F), kLevelTol);
}

// Every second row of the wall is moved by one cell: as noise of 2 cm leaves a wall that lies between two columns.
TEST(LikelihoodField, ARoughWallIsEquallyLikelyEverywhere) {
  OccupancyGrid map({.resolution_m = 0.05, .width = 60, .height = 100}, kFree);
  for (int row = 0; row < 100; ++row) map.at({30 + (row * row / 3) % 2, row}) = kOccupied;
  const LikelihoodField field = make_field(map);
  double least = 0.0, most = -10.0;
  for (double y = 1.0; y < 4.0; y += 0.05) {
    least = std::min(least, field.log_at({1.55, y})), most = std::max(most, field.log_at({1.55, y}));
  }
  // By cells alone: log(0.95 exp(-0.5 * 0.25) + 0.05) = -0.118 beside -0.
  EXPECT_LT(most - least, 0.06);
}

TEST(LikelihoodField, UsesAtMostNHitsUniformlySpreadAndFiniteOnly) {
  LevelScan scan = scan_of({{1.0F, 0.0F}, {2.0F, 0.0F}, {3.0F, 0.0F}, {4.0F, 0.0F}});
  scan.beams.push_back({{5.0F, 0.0F}, false});
  scan.beams.push_back({{std::numeric_limits<float>::quiet_NaN(), 0.0F}, true});
  EXPECT_EQ(select_beam_ends(scan, 2).x_m, (std::vector<float>{1.0F, 3.0F}));
  EXPECT_EQ(select_beam_ends(scan, 100).size(), 4U);
}

TEST(LikelihoodField, AScanWithoutHitsFitsEverywhereAlike) {
  const ScanLikelihoods fits = make_field(make_map()).evaluate({}, {{0.0, 0.0, 0.0}, {1.0, 0.0, 0.0}});
  EXPECT_EQ(fits.num_beams, 0);
  EXPECT_EQ(fits.mean_log, (std::vector<double>{0.0, 0.0}));
}

}  // namespace
}  // namespace patrol::localize::amcl_likelihood_field_test
