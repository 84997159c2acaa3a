#include "slam/scan_matcher.h"

#include <cmath>

#include <Eigen/Eigenvalues>
#include <gtest/gtest.h>

#include "core/geometry/angles.h"
#include "slam/match_points.h"
#include "slam/scan_integration.h"
#include "tests/support/pose_near.h"
#include "tests/support/room_world.h"

namespace patrol::slam::scan_matcher_test {
namespace {

using test::Pose2Near, test::RoomWorld;

/// 8 m by 6 m with a cupboard and a pillar.
RoomWorld make_room() {
  RoomWorld room;
  room.add_box(-3.0, -2.0, 5.0, 4.0).add_box(3.5, -2.0, 5.0, -1.0).add_post(-1.0, 2.5, 0.3);
  return room;
}

RoomWorld make_corridor() {
  RoomWorld corridor;
  corridor.add_wall(-50.0, -1.0, 50.0, -1.0).add_wall(-50.0, 1.0, 50.0, 1.0);
  return corridor;
}

constexpr RoomWorld::ScanOptions kNoisyLidar{
    .beams = 1600, .range_max_m = 30.0, .no_return_clearing_range_m = 6.0, .range_std_m = 0.01};

/// A map of the room from five scans with 1 cm of noise at known poses.
GridMap make_map(const RoomWorld& room) {
  GridMap map(0.05, 100.0);
  const RandomStream noise(1, "test/map");
  for (std::uint64_t i = 0; i < 5; ++i) {
    const Pose2 T_map_body{0.2 * static_cast<double>(i), 0.1, 0.3 * static_cast<double>(i)};
    integrate_scan(room.scan(T_map_body, Time{}, kNoisyLidar, noise, i), T_map_body, {}, map);
  }
  return map;
}

std::vector<MatchPoint> look(const RoomWorld& room, const Pose2& T_map_body) {
  const ScanMatcherSettings settings;
  const LevelScan scan = room.scan(T_map_body, Time{}, kNoisyLidar, RandomStream(2, "test/look"), 0);
  return downsample_scan(scan, settings.point_spacing_m, settings.max_points);
}

const Pose2 kTruth{0.47, 0.33, 0.41};

TEST(MatchScan, RecoversTenCentimetersAndThreeDegreesToFiveMillimetersAndATenthOfADegree) {
  const RoomWorld room = make_room();
  const GridMap map = make_map(room);
  for (const double sign : {-1.0, 1.0}) {
    const Pose2 start{kTruth.x + sign * 0.08, kTruth.y - sign * 0.06, kTruth.yaw + sign * 3.0 * kDegree};
    const auto match = match_scan(map, look(room, kTruth), start, std::nullopt, {});
    ASSERT_TRUE(match);
    EXPECT_THAT(match->T_map_body, Pose2Near(kTruth, 0.005, 0.1 * kDegree));
    EXPECT_TRUE(match->converged);
    EXPECT_LE(match->iterations, 8);
    EXPECT_GT(match->inlier_ratio, 0.9);
  }
}

// Single beams with the noise that the settings state; the map's own roughness makes the match say a little
// less.
TEST(MatchScan, EndsWithoutResultWhereItComesWithinFiveMillimetersAndMilliradiansOfAKnownMatch) {
  const RoomWorld room = make_room();
  const GridMap map = make_map(room);
  const std::vector<MatchPoint> points = look(room, kTruth);
  const Pose2 start{kTruth.x + 0.08, kTruth.y - 0.06, kTruth.yaw + 3.0 * kDegree};
  const auto match = match_scan(map, points, start, std::nullopt, {});
  ASSERT_TRUE(match);
  Pose2 known = match->T_map_body;
  EXPECT_FALSE(match_scan(map, points, start, std::nullopt, {}, &known));
  known.x += 0.0045;
  EXPECT_FALSE(match_scan(map, points, start, std::nullopt, {}, &known));
  for (const Pose2& offset : {Pose2{0.0055, 0.0, 0.0}, Pose2{0.0, 0.0, 0.0055}}) {
    known = {match->T_map_body.x + offset.x, match->T_map_body.y, match->T_map_body.yaw + offset.yaw};
    const auto beside = match_scan(map, points, match->T_map_body, std::nullopt, {}, &known);
    ASSERT_TRUE(beside);
    EXPECT_THAT(beside->T_map_body, Pose2Near(match->T_map_body, 2e-4, 1e-5));
  }
}

TEST(MatchScan, LogLikelihoodIsThatOfTheScanAtTheLastLinearization) {
  const RoomWorld room = make_room();
  const GridMap map = make_map(room);
  const std::vector<MatchPoint> points = look(room, kTruth);
  const auto match = match_scan(map, points, kTruth, std::nullopt, {.max_iterations = 1});
  ASSERT_TRUE(match);
  double sum = 0.0;
  for (const double value : point_log_likelihoods(map, points, kTruth, {})) sum += std::isnan(value) ? 0.0 : value;
  EXPECT_LT(sum, -1.0);
  EXPECT_DOUBLE_EQ(match->log_likelihood, sum);
}

TEST(MatchScan, CovarianceIsConsistentToAFactorOfTwo) {
  const RoomWorld room = make_room();
  const GridMap map = make_map(room);
  const ScanMatcherSettings settings{.max_points = 400, .point_spacing_m = 0.0, .point_std_m = kNoisyLidar.range_std_m};
  double squared = 0.0;  // Mahalanobis distance: 3 on average if the covariance is right
  constexpr int kLooks = 40;
  for (std::uint64_t i = 0; i < kLooks; ++i) {
    const LevelScan scan = room.scan(kTruth, Time{}, kNoisyLidar, RandomStream(3, "test/look"), i);
    const auto points = downsample_scan(scan, settings.point_spacing_m, settings.max_points);
    const auto match = match_scan(map, points, kTruth, std::nullopt, settings);
    ASSERT_TRUE(match);
    const Eigen::Vector3d error = match->T_map_body.vector() - kTruth.vector();
    squared += error.dot(match->information * error) / kLooks;
  }
  EXPECT_LT(squared, 3.0 * 4.0);
  EXPECT_GT(squared, 3.0 / 4.0);
}

TEST(MatchScan, ACorridorConstrainsLateralPositionAndHeadingOnly) {
  const RoomWorld corridor = make_corridor();
  const GridMap map = make_map(corridor);
  const Pose2 truth{0.4, 0.2, 0.0};
  const auto match = match_scan(map, look(corridor, truth), {0.4, 0.25, 1.0 * kDegree}, std::nullopt, {});
  ASSERT_TRUE(match);
  EXPECT_NEAR(match->T_map_body.y, 0.2, 0.005);
  EXPECT_NEAR(match->T_map_body.yaw, 0.0, 0.1 * kDegree);
  EXPECT_LT(match->information(0, 0), 0.01 * match->information(1, 1));
}

TEST(MatchScan, InACorridorThePriorKeepsTheLength) {
  const RoomWorld corridor = make_corridor();
  const GridMap map = make_map(corridor);
  const Pose2 truth{0.4, 0.2, 0.0}, start{0.5, 0.25, 0.0};
  const PoseGaussian prior{.mean = start,
                           .covariance = Eigen::Vector3d(0.02 * 0.02, 0.1 * 0.1, 0.02 * 0.02).asDiagonal()};
  const auto match = match_scan(map, look(corridor, truth), start, prior, {});
  ASSERT_TRUE(match);
  EXPECT_NEAR(match->T_map_body.x, 0.5, 0.01);
  EXPECT_NEAR(match->T_map_body.y, 0.2, 0.005);
}

TEST(MatchScan, WithoutMapOrPointsThereIsNoMatch) {
  const RoomWorld room = make_room();
  EXPECT_FALSE(match_scan(GridMap(0.05, 100.0), look(room, kTruth), kTruth, std::nullopt, {}));
  EXPECT_FALSE(match_scan(make_map(room), {}, kTruth, std::nullopt, {}));
}

TEST(MatchScan, FarOffThereIsNoMatchRatherThanAWrongOne) {
  const RoomWorld room = make_room();
  ScanMatcherSettings settings;
  settings.min_inlier_ratio = 0.9;
  EXPECT_FALSE(match_scan(make_map(room), look(room, kTruth), {kTruth.x + 0.7, kTruth.y - 0.6, kTruth.yaw + 0.5},
                          std::nullopt, settings));
}

TEST(MatchScan, AThirdOfThePointsOnAPersonMovesItByLessThanFiveMillimeters) {
  const RoomWorld room = make_room();
  const GridMap map = make_map(room);
  RoomWorld crowded = room;
  crowded.add_wall(1.2, -0.8, 1.9, 1.6);  // not in the map
  const auto match = match_scan(map, look(crowded, kTruth), {kTruth.x + 0.05, kTruth.y, kTruth.yaw}, std::nullopt, {});
  ASSERT_TRUE(match);
  EXPECT_LT(match->inlier_ratio, 0.95);
  EXPECT_THAT(match->T_map_body, Pose2Near(kTruth, 0.005, 0.1 * kDegree));
}

// The steps are two cells, and those two cells seen at the farthest point: a match from there must succeed.
TEST(SearchPose, ComesWithinReachOfTheMatchFromThirtyCentimetersAndSixDegrees) {
  const RoomWorld room = make_room();
  const GridMap map = make_map(room);
  const auto points = look(room, kTruth);
  const Pose2 center{kTruth.x + 0.28, kTruth.y - 0.27, kTruth.yaw + 6.0 * kDegree};
  const Pose2 found = search_pose(map, points, center, {});
  EXPECT_THAT(found, Pose2Near(kTruth, 0.1, 1.5 * kDegree));
  const auto match = match_scan(map, points, found, std::nullopt, {});
  ASSERT_TRUE(match);
  EXPECT_THAT(match->T_map_body, Pose2Near(kTruth, 0.005, 0.1 * kDegree));
}

// A line needs three cells. A point beside a lone hit is no contradiction, a point in free space is.
TEST(PointLogLikelihoods, APointNearASurfaceOfOneCellIsUnknownAndOneInFreeSpaceIsAnOutlier) {
  GridMap map(0.05, 100.0);
  map.add_free_ray({0.0, 0.02}, {4.0, 0.02}, 1, false);
  map.add_hit({2.02, 0.07});
  const std::vector<MatchPoint> points = {{.p_body = {2.02, 0.02}, .range_m = 2.0},
                                          {.p_body = {1.0, 0.02}, .range_m = 1.0}};
  const std::vector<double> log_likelihoods = point_log_likelihoods(map, points, {}, {});
  EXPECT_TRUE(std::isnan(log_likelihoods[0]));
  EXPECT_LT(log_likelihoods[1], -5.0);
}

}  // namespace
}  // namespace patrol::slam::scan_matcher_test
